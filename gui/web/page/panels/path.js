/** The tool path panel: picture, views, colours, what leaves the machine's limits, and the forecast's time line. */

import { fill, h, select, setFlag, setPressed } from "../core/dom.js";
import { openDialog } from "../core/dialog.js";
import { _ } from "../core/i18n.js";
import { iconButton } from "../core/icons.js";
import { running } from "../core/machine.js";
import { registerPanel } from "../core/panels.js";
import { recall, remember } from "../core/prefs.js";
import { length } from "../core/units.js";
import { css, plainColour } from "../path/colours.js";
import { ForecastClock, KIND, PathData } from "../path/data.js";
import { Shape } from "../path/shape.js";
import { timeline } from "../path/timeline.js";

/** @typedef {import("../core/app.js").App} App */
/** @typedef {import("../path/scene.js").Scene} Scene */

const CLICK_PIXELS = 5; // a press that moves farther turns the picture

registerPanel({
  id: "path",
  title: () => _("Tool path"),
  icon: "path",
  order: 35,
  async mount(root, app) {
    const data = new PathData();
    const place = h("div", { class: "canvas grow", role: "img", "aria-label": _("Tool path") });
    const notice = h("div", { class: "path-notice", role: "status" });
    const legend = h("div", { class: "legend" });
    const line = timeline(data, (point, number) => {
      scene.setCursor(point);
      app.store.merge({ selected_line: number });
    });
    const hint = h("p", { class: "muted hint" }, _("Loading the picture …"));
    fill(root, h("div", { class: "card path grow" }, place, legend, notice, hint, line.element));
    const { Scene } = await import("../path/scene.js");
    hint.remove();
    const { geometry, units } = app.v.config;
    const scene = new Scene(place, data, new Shape(geometry, units.degrees_per_unit));
    const bar = toolbar(app, scene, data, () => drawLegend(legend, scene, data));
    root.firstElementChild?.prepend(bar);
    receive(app, scene, data, line, () => drawLegend(legend, scene, data));
    follow(app, scene, data, line);
    watchNotice(app, data, notice);
    scene.onresize = () => scene.touched || fitAll(app, scene, data);
    picking(app, scene, place);
    return {
      show() {
        scene.visible = true;
        scene.draw();
      },
      hide() {
        scene.visible = false;
      },
    };
  },
});

/** @param {App} app @param {Scene} scene @param {PathData} data @param {() => void} recoloured */
function toolbar(app, scene, data, recoloured) {
  const { config } = app.v;
  const lathe = config.machine_type === "lathe" ? (config.back_tool_lathe ? "backlathe" : "lathe") : "";
  const view = (/** @type {string} */ name) => {
    scene.view(name);
    fitAll(app, scene, data);
  };
  const views = (lathe ? [[lathe, "XZ"], ["p", "P"]] : [["x", "X"], ["y", "Y"], ["z", "Z"], ["p", "P"]]).map(([name, text]) =>
    h("button", { type: "button", onclick: () => view(name), "aria-label": _("View {name}", { name: text }) }, text),
  );
  const colouring = select([["kind", _("By kind")], ["feed", _("By feed")], ["tool", _("By tool")]], recall("colouring", "kind"), (choice) => {
    remember("colouring", choice);
    scene.recolour(choice);
    recoloured();
  }, { "aria-label": _("Colours") });
  scene.colouring = colouring.value;
  const rapids = h("button", { type: "button", "aria-pressed": "true", onclick: () => { scene.setRapids(!scene.showRapids); setPressed(rapids, scene.showRapids); } }, _("Rapids"));
  const steps = [[0, _("No grid")], ...config.grids.map((/** @type {any} */ grid) => [grid.value, grid.text])];
  const chosen = steps.find(([step]) => step === recall("grid", 0))?.[0] ?? 0;
  const grid = select(steps, chosen, (choice) => {
    remember("grid", Number(choice));
    scene.setGrid(Number(choice));
  }, { "aria-label": _("Grid") });
  if (lathe) scene.gridAxes = [0, 2];
  view(lathe || "p");
  scene.setGrid(chosen);
  recoloured();
  app.store.watch(["theme"], () => {
    scene.setTheme();
    recoloured();
  });
  return h(
    "div",
    { class: "row path-tools" },
    h("div", { class: "segments" }, views),
    iconButton("target", _("Show all"), () => fitAll(app, scene, data), { iconOnly: true }),
    rapids,
    colouring,
    grid,
    iconButton("trash", _("Clear the trail"), () => scene.clearTrail(), { iconOnly: true }),
    iconButton("reload", _("Compute again"), () => app.act("path.again"), { iconOnly: true }),
  );
}

/** Limits of X, Y and Z as boxes want them. @param {App} app @returns {[number[], number[]]} */
function machineBox(app) {
  const limits = ["X", "Y", "Z"].map((letter) => app.v.config.axes.find((/** @type {any} */ axis) => axis.letter === letter));
  return [limits.map((axis) => axis?.min ?? 0), limits.map((axis) => axis?.max ?? 0)];
}

/** The program if there is one, else the machine. @param {App} app @param {Scene} scene @param {PathData} data */
function fitAll(app, scene, data) {
  const [low, high] = machineBox(app);
  scene.setLimits(low, high);
  const box = data.box(scene.shape) ?? (scene.limits.visible ? [low, high] : [[-50, -50, -50], [50, 50, 50]]);
  scene.fit(box[0], box[1]);
}

/** Take the frames. @param {App} app @param {Scene} scene @param {PathData} data @param {any} line @param {() => void} coloured */
function receive(app, scene, data, line, coloured) {
  app.link.on("path", (frame) => {
    if (frame.job < data.job) return;
    if (frame.job !== data.job || frame.chunk === 0) {
      data.begin(frame.job);
      scene.clear();
      line.reset();
    }
    scene.add(data.add(frame));
    if (frame.chunk === 0) fitAll(app, scene, data);
  });
  app.link.on("path_end", (frame) => {
    if (frame.job !== data.job) return;
    data.end = frame;
    scene.recolour(); // only now the range of feeds is known
    coloured();
    scene.showOutside((frame.outside ?? []).map((/** @type {any} */ one) => one.line));
    scene.select(app.v.selected_line ?? 0);
    fitAll(app, scene, data);
    app.store.merge({ path_end: frame });
  });
  app.link.on("forecast", (frame) => {
    if (frame.job !== data.job) return;
    data.addForecast(frame);
    line.reset();
  });
  app.store.watch(["program"], (v) => {
    if (v.program) return;
    data.begin(0);
    scene.clear();
    line.reset();
  });
  const subscribe = () => app.act("path.subscribe");
  app.link.on("hello", subscribe);
  subscribe();
}

/** Live tool, trail, selected line and the place in the forecast. @param {App} app @param {Scene} scene @param {PathData} data @param {any} line */
function follow(app, scene, data, line) {
  const clock = new ForecastClock();
  let was = "";
  app.store.watch(["actual_position", "position", "tool_offset", "g5x_offset", "g92_offset"], (v) => {
    const position = v.actual_position ?? v.position;
    if (!position) return;
    const tip = position.map((/** @type {number} */ place, /** @type {number} */ axis) => place - (v.tool_offset?.[axis] ?? 0));
    const text = tip.map((/** @type {number} */ value) => value.toFixed(5)).join();
    if (text !== was) scene.addTrail(tip);
    was = text;
    scene.setTool(tip, [0, 1, 2].map((axis) => (v.g5x_offset?.[axis] ?? 0) + (v.g92_offset?.[axis] ?? 0)));
  });
  app.store.watch(["selected_line"], (v) => scene.select(v.selected_line ?? 0));
  let ran = false;
  app.store.watch(["motion_line", "interp_state", "task_mode"], (v) => {
    if (running(v) && !ran) {
      clock.restart();
      scene.clearTrail();
    }
    ran = running(v);
    const time = ran && data.forecast && v.motion_line ? clock.timeOf(data.forecast, v.motion_line) : undefined;
    app.store.merge({ elapsed: time });
    line.setNow(time);
  });
}

/** A press that does not turn the picture chooses the line under it. @param {App} app @param {Scene} scene @param {HTMLElement} place */
function picking(app, scene, place) {
  let start = [0, 0];
  place.addEventListener("pointerdown", (event) => (start = [event.clientX, event.clientY]));
  place.addEventListener("pointerup", (event) => {
    if (Math.hypot(event.clientX - start[0], event.clientY - start[1]) > CLICK_PIXELS) return;
    const box = place.getBoundingClientRect();
    app.store.merge({ selected_line: scene.pick(event.clientX - box.left, event.clientY - box.top) });
  });
}

/** Say loudly when the picture or the limit check is not whole. @param {App} app @param {PathData} data @param {HTMLElement} notice */
function watchNotice(app, data, notice) {
  app.store.watch(["preview", "path_end", "program", "program_units", "unit_choice"], (v) => {
    const { preview } = v;
    const end = data.end && preview && data.end.job === preview.job ? data.end : null;
    notice.dataset.state = preview?.state ?? "";
    setFlag(notice, "hidden", !preview);
    if (!preview) return;
    if (preview.state === "running") return fill(notice, h("p", { class: "notice warn" }, _("Reading the program: {percent} %. Limits are not checked yet.", { percent: Math.round(preview.progress * 100) })));
    const parts = [];
    if (preview.state !== "whole") parts.push(h("p", { class: "notice danger" }, h("strong", null, _("This picture is not whole, and limits are not checked to the end.")), " ", preview.text || end?.text || ""));
    const count = end?.outside_count ?? 0;
    if (count) {
      parts.push(h("button", { type: "button", class: "danger", onclick: () => listOutside(app, end) }, count === 1 ? _("One line leaves the machine's limits") : _("{n} lines leave the machine's limits", { n: count })));
    }
    if (end?.notes?.length) parts.push(h("button", { type: "button", onclick: () => listNotes(app, end.notes) }, _("Assumptions: {n}", { n: end.notes.length })));
    if (!parts.length && end) parts.push(h("span", { class: "chip ok" }, _("Within the limits")));
    fill(notice, parts);
  });
}

/** @param {App} app @param {any} end */
function listOutside(app, end) {
  const rows = end.outside.map((/** @type {any} */ one) => [
    one.line,
    _("Line {line}: {axis} {value}, limit {limit}", { line: one.line, axis: one.axis, value: length(one.value, app.v), limit: length(one.limit, app.v) }),
  ]);
  listLines(app, _("Outside the limits"), rows, end.outside_count - end.outside.length);
}

/** @param {App} app @param {any[]} notes */
function listNotes(app, notes) {
  listLines(app, _("Assumptions of this picture"), notes.map((note) => [note.line, note.line ? _("Line {line}: {text}", { line: note.line, text: note.text }) : note.text]), 0);
}

/** @param {App} app @param {string} title @param {[number, string][]} rows @param {number} more */
function listLines(app, title, rows, more) {
  const choose = (/** @type {number} */ line) => {
    app.store.merge({ selected_line: line });
    dialog.close();
  };
  const dialog = openDialog(
    title,
    [h("div", { class: "stack" }, rows.map(([line, text]) => h("button", { type: "button", class: "plain", onclick: () => choose(line) }, text))), more > 0 ? h("p", { class: "muted" }, _("and {n} more", { n: more })) : null],
    [{ text: _("Close"), kind: "primary", submit: true }],
  );
}

/** @param {HTMLElement} legend @param {Scene} scene @param {PathData} data */
function drawLegend(legend, scene, data) {
  const dark = document.documentElement.dataset.theme !== "light";
  const entry = (/** @type {number[]} */ rgb, /** @type {string} */ text) => h("span", null, h("i", { style: { background: css(rgb) } }), text);
  const colour = (/** @type {number} */ kind, feed = 0, tool = 0) => plainColour(scene.colouring, kind, feed, tool, data.feedRange, dark);
  const entries = [entry(colour(KIND.RAPID), _("Rapid"))];
  if (scene.colouring === "kind") entries.push(entry(colour(KIND.FEED), _("Feed")), entry(colour(KIND.ARC), _("Arc")), entry(colour(KIND.PROBE), _("Probe")));
  else if (scene.colouring === "tool") entries.push(...(data.end?.tools ?? []).map((/** @type {number} */ tool) => entry(colour(KIND.FEED, 0, tool), `T${tool}`)));
  else if (data.feedRange[1] > 0) entries.push(...data.feedRange.map((feed) => entry(colour(KIND.FEED, feed), `F${Math.round(feed)}`)));
  fill(legend, entries);
}
