/** The run bar: start, step, pause, stop, and where the program is. Always in sight, whatever panel is open. */

import { fill, h, setAttribute, setFlag, setPressed, setText } from "../core/dom.js";
import { _ } from "../core/i18n.js";
import { icon } from "../core/icons.js";
import { idle, operator, paused, running, whyNoControl, whyNoPower, whyNotHomed } from "../core/machine.js";
import { duration } from "../core/units.js";

/** @typedef {import("../core/app.js").App} App */

/** @param {any} v */
const whyNotRun = (v) => whyNotHomed(v) || (v.program ? "" : _("Open a program first"));
/** @param {any} v */
const whyNotStep = (v) => (paused(v) ? whyNoControl(v) : whyNotRun(v));
/** @param {any} v */
const whyNotPause = (v) => whyNoControl(v) || whyNoPower(v) || (idle(v) ? _("Nothing is running") : "");

/** @param {HTMLElement} root @param {App} app */
export function mountRunbar(root, app) {
  setAttribute(root, "aria-label", _("Program run"));
  const pause = app.button("pause", _("Pause"), () => app.act(paused(app.v) ? "program.resume" : "program.pause"), whyNotPause, { id: "pause" });
  const word = /** @type {HTMLElement} */ (pause.querySelector("span"));
  let isPaused = false;
  app.store.watch(["paused", "task_paused", "interp_state"], (v) => {
    if (isPaused === paused(v)) return;
    isPaused = paused(v);
    setText(word, isPaused ? _("Resume") : _("Pause"));
    pause.classList.toggle("go", isPaused);
    pause.firstElementChild?.replaceWith(icon(isPaused ? "play" : "pause"));
  });
  fill(
    root,
    app.button("play", _("Run"), () => app.act("program.run"), whyNotRun, { id: "run", class: "go" }),
    app.button("step", _("Step"), () => app.act("program.step"), whyNotStep, { id: "step" }),
    pause,
    app.gate(
      h("button", { type: "button", id: "stop", class: "danger", onclick: () => app.act("machine.abort") }, icon("stop"), h("span", null, _("Stop"))),
      (v) => (!v.link ? _("No connection") : operator(v) ? "" : _("You may watch only")),
    ),
    toggle(app, _("Optional stop"), "optional_stop", "program.optional_stop"),
    toggle(app, _("Skip / lines"), "block_delete", "program.block_delete"),
    runState(app),
  );
}

/** @param {App} app @param {string} text @param {string} key @param {string} method */
function toggle(app, text, key, method) {
  const button = app.button("", text, () => app.act(method, { on: !app.v[key] }), whyNoControl, { class: "wide-only small" });
  app.store.watch([key], (v) => setPressed(button, Boolean(v[key])));
  return button;
}

/** @param {App} app */
function runState(app) {
  const name = h("span");
  const time = h("span", { class: "mono muted" });
  const bar = h("progress", { max: 1, value: 0, "aria-label": _("Progress of the program") });
  const message = h("span", { class: "muted" });
  app.store.watch(["program", "motion_line", "current_line", "interp_state", "task_mode", "forecast", "elapsed", "opening", "delay_left"], (v) => {
    const line = v.motion_line || v.current_line || 0;
    const total = v.program?.lines ?? 0;
    const forecast = v.forecast?.state === "whole" ? v.forecast.seconds : 0;
    setText(name, v.program ? _("{name} · line {line} of {total}", { name: v.program.name, line: running(v) ? line : 0, total }) : _("No program"));
    const rest = running(v) && forecast && v.elapsed !== undefined ? `−${duration(forecast - v.elapsed)}` : forecast ? duration(forecast) : "";
    setText(time, rest);
    const share = running(v) ? (forecast && v.elapsed !== undefined ? v.elapsed / forecast : line / Math.max(total, 1)) : 0;
    bar.value = share;
    setFlag(bar, "hidden", !v.program);
    setText(message, v.opening ? _("{name} is being converted: {percent} %", { name: v.opening.name, percent: Math.round(v.opening.percent) }) : v.delay_left > 0 ? _("Dwell {seconds} s", { seconds: v.delay_left.toFixed(1) }) : "");
  });
  return h("div", { id: "run-state" }, h("div", { class: "line" }, name, message, time), bar);
}
