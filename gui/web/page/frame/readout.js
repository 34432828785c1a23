/**
 * The position readout: work coordinates in large digits, machine position and distance to go beside them, homed and limit
 * marks. Before homing with kinematics that are not trivial, joints take the axes' place.
 */

import { fill, h, setAttribute, setText } from "../core/dom.js";
import { _ } from "../core/i18n.js";
import { icon } from "../core/icons.js";
import { coordinate, displayUnit } from "../core/units.js";
import { recall, remember } from "../core/prefs.js";

/** @typedef {import("../core/app.js").App} App */

const MIN_LIMITS = 1 | 4;
const MAX_LIMITS = 2 | 8;
const DIAMETER_MODE = 70; // G7 in tenths
const POSITIONS = ["position", "actual_position", "work_position", "work_actual_position", "dtg", "joint_position", "joint_actual_position"];

/** @param {App} app @returns {HTMLElement} */
export function readout(app) {
  const rows = h("tbody");
  const unit = h("span", { class: "unit" });
  const system = h("button", { type: "button", class: "plain system", onclick: () => app.panels.show("offsets"), "aria-label": _("Work offsets") });
  const toggle = h("button", { type: "button", class: "plain", onclick: () => showJoints(!recall("joints", false)) }, _("Joints"));
  const element = h(
    "div",
    { class: "card readout" },
    h("div", { class: "row" }, system, h("span", { class: "grow" }), unit, toggle),
    h(
      "table",
      { "aria-label": _("Position") },
      h("thead", null, h("tr", null, h("th", null, h("span", { class: "visually-hidden" }, _("Axis"))), h("th", { class: "number" }, _("Work")), h("th", { class: "number" }, _("Machine / to go")))),
      rows,
    ),
  );

  /** @type {((v: any) => void)[]} one for each row */
  let updaters = [];
  function showJoints(/** @type {boolean} */ wanted) {
    remember("joints", wanted);
    setAttribute(toggle, "aria-pressed", String(wanted));
    build();
  }
  function build() {
    const { config } = app.v;
    if (!config?.axes) return;
    const made = recall("joints", false) ? config.joints.map(jointRow) : config.axes.map((/** @type {any} */ axis) => axisRow(app, axis));
    fill(rows, made.map((/** @type {any} */ row) => row.element));
    updaters = made.map((/** @type {any} */ row) => row.update);
    update(app.v);
  }
  function update(/** @type {any} */ v) {
    if (!v.position) return;
    setText(unit, displayUnit(v));
    setText(system, systemName(v));
    for (const one of updaters) one(v);
  }
  app.store.watch(["config"], () => showJoints(recall("joints", false)));
  app.store.watch([...POSITIONS, "homed", "homing", "limit", "program_units", "g5x_index", "gcodes", "unit_choice", "rotation_xy"], update);
  return element;
}

/** @param {any} v */
function systemName(v) {
  const names = ["", "G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"];
  const rotation = v.rotation_xy ? ` ↻${v.rotation_xy.toFixed(2)}°` : "";
  return `${names[v.g5x_index] ?? ""}${rotation}`;
}

/** @param {any} v @param {string} stem `position` or `work_position` */
function shownPosition(v, stem) {
  const commanded = v.config.position_feedback === "commanded";
  return v[commanded ? stem : stem.replace("position", "actual_position")] ?? v[stem];
}

/** One axis; X of a lathe shows diameters while G7 is active. @param {App} app @param {any} axis */
function axisRow(app, axis) {
  const lathe = app.v.config.machine_type === "lathe" && axis.letter === "X";
  const letter = h("span", { class: "letter" }, axis.letter);
  const mark = h("span", { class: "mark" });
  const work = h("output", { class: "work", data: { axis: axis.letter } });
  const machine = h("output", { class: "machine" });
  const togo = h("output", { class: "togo" });
  const machineFirst = app.v.config.position_offset === "machine";
  const element = h("tr", { data: { axis: axis.letter } }, h("th", { scope: "row" }, letter, mark), h("td", { class: "number" }, work), h("td", { class: "number small" }, machine, togo));
  const update = (/** @type {any} */ v) => {
    const times = lathe && v.gcodes?.includes(DIAMETER_MODE) ? 2 : 1;
    const [big, small] = [shownPosition(v, "work_position"), shownPosition(v, "position")].map((pose) => coordinate(axis.index, times * pose[axis.index], v));
    setText(work, machineFirst ? small : big);
    setText(machine, machineFirst ? big : small);
    setText(togo, coordinate(axis.index, times * v.dtg[axis.index], v));
    if (lathe) setText(letter, times === 2 ? "X⌀" : "X");
    markAxis(element, mark, v, axis.joints);
  };
  return { element, update };
}

/** @param {any} joint */
function jointRow(joint) {
  const mark = h("span", { class: "mark" });
  const work = h("output", { class: "work", data: { joint: joint.number } });
  const ferror = h("output", { class: "machine" });
  const element = h("tr", { data: { joint: joint.number } }, h("th", { scope: "row" }, h("span", { class: "letter" }, `J${joint.number}`), mark), h("td", { class: "number" }, work), h("td", { class: "number small" }, ferror));
  const index = joint.linear ? 0 : 3;
  const update = (/** @type {any} */ v) => {
    const commanded = v.config.position_feedback === "commanded";
    const positions = (commanded ? v.joint_position : v.joint_actual_position) ?? v.joint_position;
    setText(work, coordinate(index, positions[joint.number], v));
    setText(ferror, `±${coordinate(index, Math.abs(v.joint_ferror?.[joint.number] ?? 0), v)}`);
    markAxis(element, mark, v, [joint.number]);
  };
  return { element, update };
}

/** Show homed, homing and limits. @param {HTMLElement} row @param {HTMLElement} mark @param {any} v @param {number[]} joints */
function markAxis(row, mark, v, joints) {
  const homing = joints.some((joint) => v.homing?.[joint]);
  const homed = joints.every((joint) => v.homed?.[joint]);
  const limits = joints.reduce((bits, joint) => bits | (v.limit?.[joint] ?? 0), 0);
  const state = homing ? "homing" : homed ? "homed" : "unhomed";
  if (row.dataset.state !== state || row.dataset.limits !== String(limits)) {
    row.dataset.state = state;
    row.dataset.limits = String(limits);
    const words = { homing: _("homing"), homed: _("homed"), unhomed: _("not homed") }[state];
    const limitText = [limits & MIN_LIMITS ? _("− limit") : "", limits & MAX_LIMITS ? _("+ limit") : ""].filter(Boolean).join(" ");
    fill(mark, icon("home"), h("span", { class: "visually-hidden" }, words), limitText && h("span", { class: "limit" }, limitText));
    mark.title = [words, limitText].filter(Boolean).join(", ");
  }
}
