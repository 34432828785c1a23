/** Spindle and coolant by hand; parts of the manual panel. */

import { h, setAttribute, setPressed, setText } from "../core/dom.js";
import { _ } from "../core/i18n.js";
import { whyNoControl, whyNoPower } from "../core/machine.js";
import { fixed } from "../core/units.js";

/** @typedef {import("../core/app.js").App} App */

/** @param {any} v */
const why = (v) => whyNoControl(v) || whyNoPower(v);

/** @param {App} app @param {number} n number of the spindle */
export function spindleCard(app, n) {
  const limits = app.v.config.spindles[n];
  const speed = h("input", {
    type: "number", class: "number", min: limits.min_speed, max: limits.max_speed || null, step: "any",
    value: limits.default_speed, "aria-label": _("Spindle speed"),
  });
  app.gate(speed, why);
  const run = (/** @type {number} */ direction) => app.act("spindle.on", { speed: Math.abs(speed.valueAsNumber) || limits.default_speed, direction, spindle: n });
  const reverse = app.button("left", "M4", () => run(-1), why, { "aria-label": _("Spindle counterclockwise") });
  const forward = app.button("right", "M3", () => run(1), why, { "aria-label": _("Spindle clockwise") });
  const stop = app.button("stop", "M5", () => app.act("spindle.off", { spindle: n }), why, { "aria-label": _("Stop the spindle") });
  const slower = app.button("minus", _("Slower"), () => app.act("spindle.decrease", { spindle: n }), why, { iconOnly: true });
  const faster = app.button("plus", _("Faster"), () => app.act("spindle.increase", { spindle: n }), why, { iconOnly: true });
  const brake = app.button("", _("Brake"), () => app.act("spindle.brake", { on: !app.v.spindle[n].brake, spindle: n }), (v) => why(v) || (v.spindle?.[n]?.direction ? _("The spindle is turning") : ""));
  const state = h("span", { class: "muted" });
  app.store.watch(["spindle"], (v) => {
    const spindle = v.spindle?.[n];
    if (!spindle) return;
    setPressed(forward, spindle.direction > 0);
    setPressed(reverse, spindle.direction < 0);
    setPressed(brake, Boolean(spindle.brake));
    const wait = spindle.direction && spindle.at_speed === false ? _("not yet at speed") : "";
    setText(state, spindle.direction ? `${fixed(spindle.actual_speed ?? spindle.speed, 0)} ${_("rpm")} ${wait}` : _("standing still"));
    setAttribute(state, "class", wait ? "warn" : "muted");
  });
  const title = app.v.config.spindles.length > 1 ? _("Spindle {n}", { n }) : _("Spindle");
  return h(
    "div",
    { class: "card spindle" },
    h("h2", null, title, " · ", state),
    h("div", { class: "segments" }, reverse, stop, forward),
    h("div", { class: "row" }, slower, h("div", { class: "grow with-unit" }, speed, h("span", { class: "unit" }, _("rpm"))), faster, brake),
  );
}

/** @param {App} app */
export function coolantCard(app) {
  const toggle = (/** @type {string} */ text, /** @type {string} */ key, /** @type {string} */ method) => {
    const button = app.button("", text, () => app.act(method, { on: !app.v[key] }), why, { data: { coolant: key } });
    app.store.watch([key], (v) => setPressed(button, Boolean(v[key])));
    return button;
  };
  return h(
    "div",
    { class: "card" },
    h("h2", null, _("Coolant")),
    h("div", { class: "row" }, toggle(_("Mist"), "mist", "coolant.mist"), toggle(_("Flood"), "flood", "coolant.flood"), toggle(_("Lube"), "lube", "lube")),
  );
}
