/**
 * What the state values mean: questions that several panels ask, and LinuxCNC's numbers by name.
 * Every function takes the store's values.
 */

import { _ } from "./i18n.js";

/** @typedef {import("./store.js").Values} Values */

export const STATE = Object.freeze({ ESTOP: 1, ESTOP_RESET: 2, OFF: 3, ON: 4 });
export const MODE = Object.freeze({ MANUAL: 1, AUTO: 2, MDI: 3 });
export const INTERP = Object.freeze({ IDLE: 1, READING: 2, PAUSED: 3, WAITING: 4 });
export const AXES = "XYZABCUVW";

/** Keys whose change may change what may be pressed. */
export const GATE_KEYS = [
  "link", "me", "config", "task_state", "task_mode", "interp_state", "paused", "task_paused", "all_homed", "homed", "homing",
  "control", "program", "machine", "jog", "toolchange", "spindle", "run_from", "selected_line", "limit", "tool_in_spindle",
];

/** @param {Values} v */
export const estopped = (v) => v.task_state === STATE.ESTOP;
/** @param {Values} v */
export const powered = (v) => v.task_state === STATE.ON;
/** @param {Values} v */
export const idle = (v) => v.interp_state === INTERP.IDLE;
/** @param {Values} v */
export const paused = (v) => Boolean(v.task_paused || v.paused || v.interp_state === INTERP.PAUSED) && !idle(v);
/** @param {Values} v */
export const running = (v) => v.task_mode === MODE.AUTO && !idle(v);
/** @param {Values} v */
export const homingNow = (v) => (v.homing ?? []).some(Boolean);
/** @param {Values} v */
export const connected = (v) => Boolean(v.link && v.machine === "ok");
/** @param {Values} v */
export const operator = (v) => v.me?.role === "operator";
/** @param {Values} v */
export const inControl = (v) => operator(v) && v.control?.client === v.me?.client;

/**
 * Why nothing can be commanded at all, or an empty text.
 * @param {Values} v
 */
export function whyNoControl(v) {
  if (!v.link) return _("No connection");
  if (v.machine !== "ok") return String(v.machine ?? "");
  if (!operator(v)) return _("You may watch only");
  if (!inControl(v)) return v.control ? _("{name} has the controls", { name: v.control.name }) : _("Take the controls first");
  return "";
}

/** @param {Values} v */
export function whyNoPower(v) {
  if (estopped(v)) return _("The machine is in E-stop");
  return powered(v) ? "" : _("The machine is off");
}

/** Reason that forbids manual work (jogging, MDI, touch-off), or an empty text. @param {Values} v */
export function whyNotManual(v) {
  return whyNoControl(v) || whyNoPower(v) || (idle(v) ? "" : _("A program or MDI line is running"));
}

/** @param {Values} v */
export function whyNotHomed(v) {
  return whyNotManual(v) || (v.all_homed || v.config?.no_force_homing ? "" : _("Home the machine first"));
}

/**
 * The state in words for the header.
 * @param {Values} v
 * @returns {{kind: "ok" | "warn" | "danger", text: string}}
 */
export function stateInWords(v) {
  if (!v.link) return { kind: "danger", text: _("No connection") };
  if (v.machine !== "ok") return { kind: "danger", text: _("Machine cannot be reached") };
  if (estopped(v)) return { kind: "danger", text: _("E-stop") };
  if (!powered(v)) return { kind: "warn", text: _("Machine off") };
  if (v.toolchange) return { kind: "warn", text: _("Waiting for tool {tool}", { tool: v.toolchange.tool }) };
  if (homingNow(v)) return { kind: "warn", text: _("Homing") };
  if (paused(v)) return { kind: "warn", text: _("Paused") };
  if (running(v)) return { kind: "ok", text: _("Program running") };
  if (!idle(v)) return { kind: "ok", text: _("MDI running") };
  if (!v.all_homed) return { kind: "warn", text: _("Not homed") };
  return { kind: "ok", text: _("Ready") };
}

/** @param {Values} v */
export function modeInWords(v) {
  return { [MODE.MANUAL]: _("Manual"), [MODE.AUTO]: _("Automatic"), [MODE.MDI]: _("MDI mode") }[v.task_mode] ?? "";
}
