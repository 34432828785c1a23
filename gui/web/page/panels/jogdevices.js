/** Jogging by keyboard and by gamepad, each only after the operator has switched it on for this page. */

import { h, setPressed } from "../core/dom.js";
import { _ } from "../core/i18n.js";
import { whyNotManual } from "../core/machine.js";

/** @typedef {import("../core/app.js").App} App */

/** Axis letter and direction of a key; Shift makes it fast. A lathe's arrows follow its drawing: Z lies. */
const MILL_KEYS = { ArrowLeft: ["X", -1], ArrowRight: ["X", 1], ArrowDown: ["Y", -1], ArrowUp: ["Y", 1], PageDown: ["Z", -1], PageUp: ["Z", 1], "[": ["A", -1], "]": ["A", 1] };
const LATHE_KEYS = { ArrowLeft: ["Z", -1], ArrowRight: ["Z", 1], ArrowUp: ["X", -1], ArrowDown: ["X", 1] };
const BACK_LATHE_KEYS = { ...LATHE_KEYS, ArrowUp: ["X", 1], ArrowDown: ["X", -1] };

/** Axis letter and sign for each stick axis of a gamepad in the standard layout. */
const STICKS = [["X", 1], ["Y", -1], null, ["Z", -1]];
const DEADMAN_BUTTONS = [4, 5]; // the shoulder buttons: one must be held
const DEAD_ZONE = 0.18;
const SPEED_STEP = 0.05; // share of full speed below which a change is not sent

/** The two switches. @param {App} app */
export function inputSwitches(app) {
  return [keyboardSwitch(app), gamepadSwitch(app)];
}

/** @param {App} app */
function keyboardSwitch(app) {
  const { config } = app.v;
  const keys = /** @type {Record<string, any[]>} */ (config.machine_type !== "lathe" ? MILL_KEYS : config.back_tool_lathe ? BACK_LATHE_KEYS : LATHE_KEYS);
  let on = false;
  const button = app.gate(
    h("button", { type: "button", id: "keyboard-jog", "aria-pressed": "false", onclick: () => set(!on) }, _("Keyboard")),
    whyNotManual,
  );
  const set = (/** @type {boolean} */ wanted) => {
    on = wanted;
    setPressed(button, on);
    if (on) app.notify("notice", _("Arrow keys and Page up/down jog now, with Shift at full speed. They stop when you let go or leave the window."));
    else app.jogger.stopAll();
  };
  const wanted = (/** @type {KeyboardEvent} */ event) => {
    const target = /** @type {HTMLElement} */ (event.target);
    const typing = target.matches?.("input, textarea, select, [role=tab], [contenteditable]") || document.querySelector("dialog[open]");
    return on && !typing && app.panels.isVisible("manual") && !event.ctrlKey && !event.altKey && !event.metaKey ? keys[event.key] : undefined;
  };
  document.addEventListener("keydown", (event) => {
    const key = wanted(event);
    const axis = key && config.axes.find((/** @type {any} */ one) => one.letter === key[0]);
    if (!axis) return;
    event.preventDefault();
    if (!event.repeat) app.jogger.press(`key:${event.key}`, app.jogger.target(axis), app.jogger.velocity(axis.linear, key[1], event.shiftKey), app.jogger.increment(axis.linear));
  });
  document.addEventListener("keyup", (event) => app.jogger.release(`key:${event.key}`));
  return button;
}

/** @param {App} app */
function gamepadSwitch(app) {
  let on = false;
  /** @type {Map<string, number>} share of full speed sent last, by axis letter */
  const moving = new Map();
  const button = app.gate(
    h("button", { type: "button", id: "gamepad-jog", "aria-pressed": "false", onclick: () => set(!on) }, _("Gamepad")),
    whyNotManual,
  );
  const set = (/** @type {boolean} */ wanted) => {
    on = wanted;
    setPressed(button, on);
    if (!on) return app.jogger.stopAll();
    app.notify("notice", _("Hold a shoulder button and move a stick to jog: left stick X and Y, right stick Z."));
    requestAnimationFrame(look);
  };
  function look() {
    if (!on) return;
    const pad = navigator.getGamepads().find((one) => one?.connected);
    const held = pad && document.hasFocus() && DEADMAN_BUTTONS.some((number) => pad.buttons[number]?.pressed);
    STICKS.forEach((stick, n) => stick && follow(String(stick[0]), held && pad ? Number(stick[1]) * pad.axes[n] : 0));
    requestAnimationFrame(look);
  }
  function follow(/** @type {string} */ letter, /** @type {number} */ deflection) {
    const axis = app.v.config.axes.find((/** @type {any} */ one) => one.letter === letter);
    const holder = `pad:${letter}`;
    const share = Math.abs(deflection) < DEAD_ZONE ? 0 : deflection;
    const last = app.jogger.holding(holder) ? (moving.get(letter) ?? 0) : 0;
    if (!axis || share === last) return;
    if (share === 0 || Math.sign(share) === -Math.sign(last)) {
      moving.delete(letter);
      app.jogger.release(holder);
    } else if (last === 0) {
      moving.set(letter, share);
      app.jogger.hold(holder, app.jogger.target(axis), app.jogger.velocity(axis.linear, share));
    } else if (Math.abs(share - last) >= SPEED_STEP) {
      moving.set(letter, share);
      app.jogger.change(holder, app.jogger.velocity(axis.linear, share));
    }
  }
  return button;
}
