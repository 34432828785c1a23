/** The offsets panel: work coordinate systems with their rotation, G92, G28, G30 and the tool's offset. */

import { fill, h, setText } from "../core/dom.js";
import { confirm } from "../core/dialog.js";
import { evaluate } from "../core/expression.js";
import { _ } from "../core/i18n.js";
import { turns } from "../core/link.js";
import { whyNotHomed, whyNotManual } from "../core/machine.js";
import { registerPanel } from "../core/panels.js";
import { coordinate, displayUnit, fixed, scale } from "../core/units.js";

/** @typedef {import("../core/app.js").App} App */

registerPanel({
  id: "offsets",
  title: () => _("Offsets"),
  icon: "offsets",
  order: 40,
  mount(root, app) {
    const table = h("table", { class: "offsets" });
    const others = h("table", { class: "offsets" });
    const unit = h("span", { class: "chip" });
    const turn = turns();
    let drawn = "";
    const read = async () => {
      const newest = turn();
      const found = await app.call("offsets.read").catch(() => null);
      const wanted = JSON.stringify([found, displayUnit(app.v)]);
      if (!found || !newest() || wanted === drawn) return; // a table that is drawn anew loses what is being typed into it
      drawn = wanted;
      setText(unit, displayUnit(app.v));
      app.release(table);
      fill(table, headRow(app, [_("Rotation"), _("Choice")]), h("tbody", null, found.systems.map((/** @type {any} */ system) => systemRow(app, system, found.active))));
      fill(others, headRow(app, []), h("tbody", null, otherRows(found).map(([name, pose]) => plainRow(app, name, pose))));
    };
    app.store.watch(["offsets", "g5x_index", "program_units", "unit_choice", "g92_offset", "tool_offset"], () => app.panels?.isVisible("offsets") && read());
    fill(
      root,
      h("div", { class: "card stack" }, h("div", { class: "row" }, h("h2", { class: "heading grow" }, _("Work coordinate systems")), unit), h("div", { class: "scroll" }, table)),
      h(
        "div",
        { class: "card stack" },
        h("div", { class: "row" }, h("h2", { class: "heading grow" }, _("Other offsets and positions")), app.button("trash", _("Clear G92"), () => clearG92(app), whyNotManual)),
        h("div", { class: "scroll" }, others),
      ),
    );
    return { show: read };
  },
});

/** @param {App} app @param {string[]} more */
function headRow(app, more) {
  const letters = app.v.config.axes.map((/** @type {any} */ axis) => axis.letter);
  return h("thead", null, h("tr", null, h("th", null, _("System")), letters.map((/** @type {string} */ letter) => h("th", { class: "number" }, letter)), more.map((text) => h("th", { class: "number" }, text))));
}

/** @param {App} app @param {any} system @param {number} active */
function systemRow(app, system, active) {
  const { v } = app;
  const cells = v.config.axes.map((/** @type {any} */ axis) =>
    cell(app, `${system.name} ${axis.letter}`, coordinate(axis.index, system.offset[axis.index], v), (number) => write(app, system.index, axis.letter, axis.linear ? number / scale(v) : number)),
  );
  const rotation = cell(app, `${system.name} ${_("Rotation")}`, fixed(system.rotation, 3), (number) => write(app, system.index, "R", number));
  const use = app.button("", active === system.index ? _("active") : _("Use"), () => app.act("mdi.run", { text: system.name }), (v) => (active === system.index ? _("This system is active") : whyNotHomed(v)), { class: "plain" });
  return h("tr", { class: active === system.index ? "current" : "" }, h("th", { scope: "row" }, system.name), cells.map((/** @type {any} */ one) => h("td", null, one)), h("td", null, rotation), h("td", null, use));
}

/** @param {App} app @param {number} system @param {string} letter @param {number} value machine units or degrees */
function write(app, system, letter, value) {
  return app.act("offsets.write", { system, values: { [letter]: value } });
}

/**
 * A number that can be changed in place; Enter or leaving the field writes it.
 * @param {App} app @param {string} label @param {string} text @param {(value: number) => Promise<boolean>} change
 */
function cell(app, label, text, change) {
  const input = h("input", { type: "text", inputmode: "decimal", class: "number", value: text, "aria-label": label });
  input.addEventListener("change", async () => {
    const number = evaluate(input.value, displayUnit(app.v));
    input.setAttribute("aria-invalid", String(Number.isNaN(number)));
    if (Number.isNaN(number)) return;
    if (!(await change(number))) input.value = text;
  });
  return app.gate(input, whyNotManual);
}

/** @param {any} found @returns {[string, number[]][]} */
function otherRows(found) {
  return [
    [found.g92_active ? _("G92 (active)") : "G92", found.g92],
    ["G28", found.g28],
    ["G30", found.g30],
    [_("Tool"), found.tool],
  ];
}

/** @param {App} app @param {string} name @param {number[]} pose */
function plainRow(app, name, pose) {
  return h("tr", null, h("th", { scope: "row" }, name), app.v.config.axes.map((/** @type {any} */ axis) => h("td", { class: "number" }, coordinate(axis.index, pose?.[axis.index] ?? 0, app.v))));
}

/** @param {App} app */
async function clearG92(app) {
  if (await confirm("G92", _("Set the G92 offset to zero?"), _("Clear"))) app.act("offsets.clear_g92");
}
