/** The oscilloscope: samples HAL pins at the rate of their thread, with a trigger, drawn with uPlot. */

import { field, fill, h, select, setPressed, setText } from "../core/dom.js";
import { _ } from "../core/i18n.js";
import { iconButton } from "../core/icons.js";
import { registerPanel } from "../core/panels.js";
import { recall, remember } from "../core/prefs.js";

/** @typedef {import("../core/app.js").App} App */

const COLOURS = ["#4b9df8", "#e69f00", "#3ec46d", "#e06fb0", "#e2603a", "#8a8aff", "#b4b43c", "#30b8b8", "#a0a0a0", "#c08050", "#60a0c0", "#d0d060", "#70c090", "#c070d0", "#d07070", "#7080d0"];
const MOST_PINS = 16;

registerPanel({
  id: "scope",
  title: () => _("Scope"),
  icon: "scope",
  order: 80,
  async mount(root, app) {
    const settings = recall("scope", { pins: ["joint.0.pos-cmd", "joint.0.vel-cmd"], samples: 2000, before: 200, edge: "", pin: "", level: 0, repeat: true });
    const keep = () => remember("scope", settings);
    const chips = h("div", { class: "row" });
    const trigger = h("div", { class: "row" });
    const status = h("span", { class: "chip" }, _("Stopped"));
    const plot = h("div", { class: "scope-plot grow" });
    const curve = await plotter(plot); // first of all, or a record that is there at once would find nobody to draw it
    const names = h("datalist", { id: "scope-names" });
    const input = h("input", { type: "text", list: "scope-names", placeholder: _("Add a pin or signal"), "aria-label": _("Add a pin or signal"), class: "grow" });
    const draw = () => {
      fill(chips, settings.pins.map((/** @type {string} */ pin, /** @type {number} */ n) =>
        h("button", { type: "button", class: "chip-button", style: { borderColor: COLOURS[n] }, "aria-label": _("Remove {name}", { name: pin }), onclick: () => {
          settings.pins.splice(n, 1);
          keep();
          draw();
        } }, h("i", { style: { background: COLOURS[n] } }), h("span", { class: "mono" }, pin), "×"),
      ));
      const level = h("input", { type: "number", step: "any", value: settings.level, class: "number", onchange: () => { settings.level = level.valueAsNumber || 0; keep(); } });
      fill(
        trigger,
        field(_("Trigger"), select([["", _("none")], ["rising", _("rising")], ["falling", _("falling")]], settings.edge, (edge) => { settings.edge = edge; keep(); })),
        field(_("on"), select(settings.pins.map((/** @type {string} */ pin) => [pin, pin]), settings.pin, (pin) => { settings.pin = pin; keep(); })),
        field(_("Level"), level),
      );
    };
    const add = () => {
      const pin = input.value.trim();
      if (pin && !settings.pins.includes(pin) && settings.pins.length < MOST_PINS) settings.pins.push(pin);
      input.value = "";
      keep();
      draw();
    };
    input.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => event.key === "Enter" && add());
    input.addEventListener("input", async () => {
      if (input.value.length < 2) return;
      const found = await app.link.call("hal.tree", { filter: input.value, kinds: ["pin", "sig"] }).catch(() => ({ items: [] }));
      fill(names, found.items.slice(0, 40).map((/** @type {any} */ item) => h("option", { value: item.name })));
    });
    const samples = h("input", { type: "number", class: "number", min: 100, max: 100000, step: 100, value: settings.samples, onchange: () => { settings.samples = samples.valueAsNumber || 2000; keep(); } });
    const repeat = h("button", { type: "button", "aria-pressed": String(settings.repeat), onclick: () => { settings.repeat = !settings.repeat; setPressed(repeat, settings.repeat); keep(); } }, _("Again and again"));
    const start = async () => {
      const edge = settings.edge ? { trigger: { pin: settings.pin || settings.pins[0], edge: settings.edge, level: settings.level } } : {};
      if (await app.act("scope.start", { pins: settings.pins, samples: settings.samples, before: Math.round(settings.samples / 10), repeat: settings.repeat, ...edge })) setText(status, settings.edge ? _("Waiting for the trigger") : _("Recording"));
    };
    const stop = async () => {
      await app.act("scope.stop");
      setText(status, _("Stopped"));
    };
    fill(
      root,
      h(
        "div",
        { class: "card stack grow" },
        h("div", { class: "row" }, iconButton("play", _("Record"), start, { class: "go", id: "scope-start" }), iconButton("stop", _("End"), stop), repeat, field(_("Samples"), samples), status),
        h("div", { class: "row" }, input, names, iconButton("plus", _("Add"), add)),
        chips,
        trigger,
        plot,
      ),
    );
    draw();
    app.link.on("scope", (frame) => {
      curve.show(frame);
      setText(status, frame.done && !settings.repeat ? _("Done") : _("Recording"));
    });
    return { hide: () => app.link.call("scope.stop").catch(() => {}) };
  },
});

/** @param {HTMLElement} place */
async function plotter(place) {
  const { default: UPlot } = await import("../vendor/uplot/uPlot.esm.js");
  document.head.append(h("link", { rel: "stylesheet", href: new URL("../vendor/uplot/uPlot.min.css", import.meta.url).href }));
  /** @type {any} */
  let plot = null;
  let pins = "";
  new ResizeObserver(() => plot?.setSize({ width: place.clientWidth, height: Math.max(place.clientHeight - 60, 160) })).observe(place);
  const make = (/** @type {string[]} */ names) => {
    plot?.destroy();
    const style = getComputedStyle(document.documentElement);
    const text = style.getPropertyValue("--muted");
    const grid = { stroke: style.getPropertyValue("--line"), width: 1 };
    plot = new UPlot(
      {
        width: place.clientWidth, height: Math.max(place.clientHeight - 60, 160),
        scales: { x: { time: false }, ...Object.fromEntries(names.map((name) => [name, {}])) },
        axes: [{ stroke: text, grid, label: _("Time, s"), labelSize: 20 }, ...names.slice(0, 2).map((name, n) => ({ scale: name, stroke: COLOURS[n], grid: n ? { show: false } : grid, side: n ? 1 : 3, size: 70 }))],
        series: [{}, ...names.map((name, n) => ({ label: name, scale: name, stroke: COLOURS[n], width: 1.5 }))],
      },
      [[], ...names.map(() => [])],
      place,
    );
  };
  return {
    /** @param {any} frame */
    show(frame) {
      const key = frame.pins.join();
      if (key !== pins) make(frame.pins);
      pins = key;
      const data = new Float32Array(frame.data.slice().buffer);
      const columns = frame.pins.map((/** @type {string} */ _pin, /** @type {number} */ n) => Float32Array.from({ length: frame.samples }, (_unused, k) => data[k * frame.pins.length + n]));
      plot.setData([Float64Array.from({ length: frame.samples }, (_unused, k) => (k - (frame.trigger ?? 0)) * frame.period), ...columns]);
    },
  };
}
