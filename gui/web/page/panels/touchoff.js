/** The touch-off dialogs: say what the present position shall be, for an axis in a work system or for the loaded tool. */

import { field, h, select } from "../core/dom.js";
import { openDialog } from "../core/dialog.js";
import { _ } from "../core/i18n.js";
import { numpad } from "../core/numpad.js";
import { coordinate } from "../core/units.js";

/** @typedef {import("../core/app.js").App} App */

const SYSTEMS = ["G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"];
const PROGRAM_UNIT = /** @type {Record<number, "mm" | "inch">} */ ({ 1: "inch", 2: "mm", 3: "mm" });

/** @param {App} app @param {any} axis an entry of `config.axes` */
export function touchOffAxis(app, axis) {
  const { v } = app;
  let system = v.g5x_index ?? 1;
  const pad = numpad(_("New position of {axis}", { axis: axis.letter }), "0", programUnit(v));
  openDialog(
    _("Touch off {axis}", { axis: axis.letter }),
    [
      h("p", { class: "muted" }, _("The tool stands at {axis} {position} now. What shall this position be?", { axis: axis.letter, position: coordinate(axis.index, v.work_position[axis.index], v) })),
      unitLine(axis, v),
      pad.element,
      field(_("Work system"), select(SYSTEMS.map((name, n) => [n + 1, name]), system, (value) => (system = Number(value)))),
    ],
    [
      { text: _("Cancel") },
      {
        text: _("Touch off"), kind: "primary", submit: true,
        act: async (close) => {
          const value = pad.value();
          if (Number.isFinite(value) && (await app.act("touchoff.axis", { axis: axis.letter, value, system }))) close();
        },
      },
    ],
  );
}

/** @param {App} app */
export function touchOffTool(app) {
  const { v } = app;
  const letters = v.config.axes.filter((/** @type {any} */ axis) => axis.linear).map((/** @type {any} */ axis) => axis.letter);
  let axis = letters.includes("Z") ? "Z" : letters[0];
  let fixture = false;
  const pad = numpad(_("Position of the tool tip"), "0", programUnit(v));
  openDialog(
    _("Touch off tool {tool}", { tool: v.tool_in_spindle }),
    [
      h("p", { class: "muted" }, _("Touch the tool on a surface whose position you know. The tool's offset is then set so that the readout shows this position.")),
      field(_("Axis"), select(letters.map((/** @type {string} */ letter) => [letter, letter]), axis, (value) => (axis = value))),
      pad.element,
      field(
        _("Measured from"),
        select([["work", _("the workpiece (active work system)")], ["fixture", _("a fixture (G59.3)")]], "work", (value) => (fixture = value === "fixture")),
      ),
    ],
    [
      { text: _("Cancel") },
      {
        text: _("Touch off"), kind: "primary", submit: true,
        act: async (close) => {
          const value = pad.value();
          if (Number.isFinite(value) && (await app.act("touchoff.tool", { axis, value, fixture }))) close();
        },
      },
    ],
  );
}

/** @param {any} v */
function programUnit(v) {
  return PROGRAM_UNIT[v.program_units] ?? "mm";
}

/** @param {any} axis @param {any} v */
function unitLine(axis, v) {
  return h("p", { class: "muted" }, axis.linear ? _("In {unit}. Sums such as 10+25.4/2 and units such as 1in are understood.", { unit: programUnit(v) }) : _("In degrees."));
}
