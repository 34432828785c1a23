/** Override sliders that are always at hand: feed, rapid, each spindle, greatest velocity; with their real values. */

import { fill, h, setAttribute, setText } from "../core/dom.js";
import { _ } from "../core/i18n.js";
import { whyNoControl } from "../core/machine.js";
import { displayUnit, fixed, scale } from "../core/units.js";

/** @typedef {import("../core/app.js").App} App */

const SEND_MS = 60; // between two values of a slider that is being dragged

/** @param {App} app @returns {HTMLElement} */
export function overrides(app) {
  const element = h("div", { class: "card overrides" });
  app.store.watch(["config"], (v) => {
    if (!v.config?.overrides) return;
    app.release(element);
    fill(element, speedLine(app), ...rows(app));
  });
  return element;
}

/** @param {App} app */
function rows(app) {
  const { config } = app.v;
  const percent = (/** @type {number} */ value) => `${Math.round(value * 100)} %`;
  const spindles = config.spindles.map((/** @type {any} */ limits, /** @type {number} */ n) =>
    slider(app, {
      label: config.spindles.length > 1 ? _("Spindle {n}", { n }) : _("Spindle"),
      min: limits.min_override, max: limits.max_override, step: 0.01, reset: 1,
      keys: ["spindle"], read: (v) => v.spindle?.[n]?.override ?? 1, show: percent,
      send: (value) => app.act("override.spindle", { value, spindle: n }),
    }),
  );
  return [
    slider(app, {
      label: _("Feed"), min: 0, max: config.overrides.feed_max, step: 0.01, reset: 1,
      keys: ["feedrate"], read: (v) => v.feedrate, show: percent, send: (value) => app.act("override.feed", { value }),
    }),
    slider(app, {
      label: _("Rapid"), min: 0, max: config.overrides.rapid_max, step: 0.01, reset: 1,
      keys: ["rapidrate"], read: (v) => v.rapidrate, show: percent, send: (value) => app.act("override.rapid", { value }),
    }),
    ...spindles,
    slider(app, {
      label: _("Max. speed"), min: 0, max: config.max_velocity, step: config.max_velocity / 100, reset: config.max_velocity,
      keys: ["max_velocity", "program_units", "unit_choice"], read: (v) => v.max_velocity,
      show: (value) => `${fixed(value * scale(app.v) * 60, 0)}`, send: (value) => app.act("override.max_velocity", { value }),
    }),
  ];
}

/**
 * @typedef {object} Slider
 * @property {string} label @property {number} min @property {number} max @property {number} step
 * @property {number} reset value of the button beside it
 * @property {string[]} keys @property {(v: any) => number} read @property {(value: number) => string} show
 * @property {(value: number) => Promise<unknown>} send
 */

/** @param {App} app @param {Slider} slider */
function slider(app, { label, min, max, step, reset, keys, read, show, send }) {
  let dragging = false;
  let sending = false;
  /** @type {number | null} */
  let next = null;
  const shown = h("output", { class: "mono" });
  const input = h("input", { type: "range", min, max, step, "aria-label": label });
  /** One value is under way at a time; the newest one follows. @param {number} value */
  async function push(value) {
    next = value;
    if (sending) return;
    sending = true;
    while (next !== null) {
      const now = next;
      next = null;
      await Promise.all([send(now), new Promise((resolve) => setTimeout(resolve, SEND_MS))]);
    }
    sending = false;
  }
  input.addEventListener("input", () => {
    dragging = true;
    setText(shown, show(input.valueAsNumber));
    push(input.valueAsNumber);
  });
  for (const end of ["change", "blur"]) {
    input.addEventListener(end, () => {
      dragging = false;
    });
  }
  app.gate(input, whyNoControl);
  app.store.watch(keys, (v) => {
    const value = read(v);
    if (dragging || value === undefined) return;
    input.value = String(value);
    setText(shown, show(value));
    setAttribute(input, "aria-valuetext", show(value));
  });
  const button = app.button("", _("Reset {what}", { what: label }), () => push(reset), whyNoControl, { iconOnly: true, class: "reset" });
  button.append(h("span", null, label), shown);
  return h("div", { class: "override" }, button, input);
}

/** Present path speed and spindle speed. @param {App} app */
function speedLine(app) {
  const velocity = h("output", { class: "mono" });
  const unit = h("span", { class: "muted" });
  const spindle = h("output", { class: "mono" });
  app.store.watch(["current_vel", "spindle", "program_units", "unit_choice"], (v) => {
    if (v.current_vel === undefined) return;
    setText(velocity, fixed(v.current_vel * scale(v) * 60, displayUnit(v) === "mm" ? 0 : 1));
    setText(unit, `${displayUnit(v)}/min`);
    const first = v.spindle?.[0];
    setText(spindle, fixed(first?.actual_speed ?? first?.speed ?? 0, 0));
  });
  return h(
    "div",
    { class: "speeds" },
    h("div", null, h("span", { class: "muted" }, _("Feed")), " ", velocity, " ", unit),
    h("div", null, h("span", { class: "muted" }, "S"), " ", spindle, " ", h("span", { class: "muted" }, _("rpm"))),
  );
}
