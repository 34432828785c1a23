/** The tools panel: the tool table with an editor for one tool at a time, and loading of tools. */

import { field, fill, h, select, setText } from "../core/dom.js";
import { confirm, openDialog } from "../core/dialog.js";
import { evaluate } from "../core/expression.js";
import { _ } from "../core/i18n.js";
import { turns } from "../core/link.js";
import { idle, operator, whyNoControl, whyNotHomed } from "../core/machine.js";
import { registerPanel } from "../core/panels.js";
import { coordinate, displayUnit, fixed, length, scale } from "../core/units.js";

/** @typedef {import("../core/app.js").App} App */

/** @param {any} v */
const whyNotEdit = (v) => whyNoControl(v) || (idle(v) ? "" : _("A program or MDI line is running"));

registerPanel({
  id: "tools",
  title: () => _("Tools"),
  icon: "tools",
  order: 50,
  mount(root, app) {
    /** @type {{version: unknown, tools: any[]}} */
    let table = { version: null, tools: [] };
    const body = h("tbody");
    const search = h("input", { type: "search", class: "grow", placeholder: _("Search"), "aria-label": _("Search"), oninput: () => draw() });
    const turn = turns();
    let drawn = "";
    const read = async () => {
      const newest = turn();
      const found = await app.call("tools.read").catch(() => table);
      if (!newest()) return;
      table = found;
      const wanted = JSON.stringify([table, app.v.tool_in_spindle, displayUnit(app.v)]);
      if (wanted !== drawn) draw(); // rows that are drawn anew miss a press that is under way
      drawn = wanted;
    };
    const write = async (/** @type {unknown} */ version, /** @type {any[]} */ tools) => {
      const done = await app.act("tools.write", { version, tools });
      await read();
      return done;
    };
    const head = h("tr");
    function draw() {
      const { v } = app;
      const axes = v.config.axes.filter((/** @type {any} */ axis) => table.tools.some((tool) => tool.offset[axis.index]) || axis.letter === "Z" || (axis.letter === "X" && lathe(v)));
      const words = search.value.toLowerCase();
      const tools = table.tools.filter((tool) => `t${tool.tool} p${tool.pocket} ${tool.comment}`.toLowerCase().includes(words));
      fill(head, [_("Tool"), _("Pocket")].map((text) => h("th", null, text)), axes.map((/** @type {any} */ axis) => h("th", { class: "number" }, axis.letter)), h("th", { class: "number" }, "⌀"), lathe(v) ? h("th", { class: "number" }, _("Orientation")) : null, h("th", null, _("Remark")), h("th", null, h("span", { class: "visually-hidden" }, _("Actions"))));
      app.release(body);
      fill(body, tools.map((tool) => row(app, tool, axes, () => edit(tool))));
    }
    const edit = (/** @type {any} */ tool) => {
      const { version, tools } = table; // as the operator sees them now; the server refuses what is based on an older table
      const others = tools.filter((one) => one.tool !== tool.tool || one.pocket !== tool.pocket);
      editTool(app, tool, {
        save: (changed) => write(version, [...others, changed].sort((a, b) => a.pocket - b.pocket)),
        remove: () => write(version, others),
      });
    };
    const add = () => {
      const free = 1 + Math.max(0, ...table.tools.map((tool) => tool.tool));
      const pocket = 1 + Math.max(0, ...table.tools.map((tool) => tool.pocket));
      edit({ tool: free, pocket, offset: Array(9).fill(0), diameter: 0, frontangle: 0, backangle: 0, orientation: 0, comment: "", fresh: true });
    };
    const spindle = h("span", { class: "chip ok" });
    app.store.watch(["tool_in_spindle"], (v) => setText(spindle, v.tool_in_spindle ? _("T{tool} in the spindle", { tool: v.tool_in_spindle }) : _("No tool in the spindle")));
    app.store.watch(["tools", "tool_in_spindle", "program_units", "unit_choice"], () => app.panels?.isVisible("tools") && read());
    fill(
      root,
      h(
        "div",
        { class: "card stack grow" },
        h("div", { class: "row" }, spindle, search, app.button("", _("Unload"), () => app.act("toolchange.load", { tool: 0 }), (v) => whyNotHomed(v) || (v.tool_in_spindle ? "" : _("No tool in the spindle"))), app.button("plus", _("New tool"), add, whyNotEdit)),
        h("div", { class: "scroll grow" }, h("table", { class: "tools" }, h("thead", null, head), body)),
      ),
    );
    return { show: read };
  },
});

/** @param {any} v */
const lathe = (v) => v.config.machine_type === "lathe";

/** @param {App} app @param {any} tool @param {any[]} axes @param {() => void} edit */
function row(app, tool, axes, edit) {
  const { v } = app;
  const loaded = tool.tool === v.tool_in_spindle && tool.tool > 0;
  return h(
    "tr",
    { class: loaded ? "current" : "", data: { tool: tool.tool } },
    h("th", { scope: "row" }, `T${tool.tool}`),
    h("td", null, `P${tool.pocket}`),
    axes.map((axis) => h("td", { class: "number" }, coordinate(axis.index, tool.offset[axis.index], v))),
    h("td", { class: "number" }, length(tool.diameter, v)),
    lathe(v) ? h("td", { class: "number" }, String(tool.orientation)) : null,
    h("td", { class: "grow" }, tool.comment),
    h(
      "td",
      { class: "actions" },
      app.button("", _("Load"), () => app.act("toolchange.load", { tool: tool.tool }), (v) => whyNotHomed(v) || (loaded ? _("This tool is loaded") : ""), { "aria-label": _("Load T{tool}", { tool: tool.tool }) }),
      app.button("edit", _("Edit T{tool}", { tool: tool.tool }), edit, (v) => (operator(v) ? "" : _("You may watch only")), { iconOnly: true, class: "plain" }),
    ),
  );
}

/**
 * @param {App} app @param {any} tool
 * @param {{save: (tool: any) => Promise<boolean>, remove: () => Promise<boolean>}} actions
 */
function editTool(app, tool, { save, remove }) {
  const { v } = app;
  const unit = displayUnit(v);
  const number = (/** @type {string} */ text) => h("input", { type: "text", inputmode: "decimal", class: "number", value: text });
  const inputs = {
    tool: number(String(tool.tool)), pocket: number(String(tool.pocket)), diameter: number(length(tool.diameter, v)),
    frontangle: number(fixed(tool.frontangle, 3)), backangle: number(fixed(tool.backangle, 3)),
  };
  const offsets = v.config.axes.map((/** @type {any} */ axis) => ({ axis, input: number(coordinate(axis.index, tool.offset[axis.index], v)) }));
  const comment = h("input", { type: "text", value: tool.comment, maxlength: 100 });
  let { orientation } = tool;
  const collect = () => {
    const value = (/** @type {HTMLInputElement} */ input) => {
      const result = evaluate(input.value, unit);
      input.setAttribute("aria-invalid", String(Number.isNaN(result)));
      return result;
    };
    const offset = [...tool.offset];
    for (const { axis, input } of offsets) offset[axis.index] = axis.linear ? value(input) / scale(v) : value(input);
    const made = {
      tool: value(inputs.tool), pocket: value(inputs.pocket), offset, diameter: value(inputs.diameter) / scale(v),
      frontangle: value(inputs.frontangle), backangle: value(inputs.backangle), orientation, comment: comment.value.trim(),
    };
    return Object.values(made).flat().some((one) => Number.isNaN(one)) ? null : made;
  };
  openDialog(
    tool.fresh ? _("New tool") : _("Tool T{tool}", { tool: tool.tool }),
    [
      h(
        "div",
        { class: "grid two" },
        field(_("Number"), inputs.tool), field(_("Pocket"), inputs.pocket),
        offsets.map((/** @type {any} */ one) => field(_("Offset {axis}", { axis: one.axis.letter }), one.input, one.axis.linear ? unit : "°")),
        field(_("Diameter"), inputs.diameter, unit),
        lathe(v) ? [field(_("Front angle"), inputs.frontangle, "°"), field(_("Back angle"), inputs.backangle, "°"), field(_("Orientation"), select([...Array(10).keys()].map((n) => [n, String(n)]), orientation, (text) => (orientation = Number(text))))] : null,
      ),
      field(_("Remark"), comment),
    ],
    [
      ...(tool.fresh ? [] : [{ text: _("Remove"), kind: "danger", act: async (/** @type {() => void} */ close) => {
        if ((await confirm(_("Remove"), _("Remove T{tool} from the tool table?", { tool: tool.tool }), _("Remove"), "danger")) && (await remove())) close();
      } }]),
      ...(tool.fresh || !tool.tool ? [] : [{ text: _("It is in the spindle"), act: async (/** @type {() => void} */ close) => {
        if (await app.act("toolchange.declare", { tool: tool.tool })) close();
      } }]),
      { text: _("Cancel") },
      { text: _("Save"), kind: "primary", submit: true, act: async (/** @type {() => void} */ close) => {
        const made = collect();
        if (made && (await save(made))) close();
      } },
    ],
    { wide: true },
  );
}
