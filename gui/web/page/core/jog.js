/**
 * Continuous jogs that last as long as something is held: a button, a key, a stick. While one is held the page sends beats;
 * it stops sending, and says stop, when the holder lets go, the window loses the focus or is hidden, or the connection is
 * lost. The server and motion stop by themselves when beats do not come.
 */

import { recall, remember } from "./prefs.js";
import { GATE_KEYS, whyNotManual } from "./machine.js";

/**
 * @typedef {{axis: string} | {joint: number}} Target
 *
 * @typedef {object} Hold
 * @property {Target} target
 * @property {number | null} jog the server's number, null until it has answered
 * @property {boolean} released
 */

export class Jogger {
  /** @type {Map<string, Hold>} by what holds it, such as `pointer` or `key:ArrowLeft` */
  #holds = new Map();
  /** @type {ReturnType<typeof setInterval> | undefined} */
  #timer;

  /** @param {import("./app.js").App} app */
  constructor(app) {
    this.app = app;
    window.addEventListener("blur", () => this.stopAll());
    window.addEventListener("pagehide", () => this.stopAll());
    document.addEventListener("visibilitychange", () => document.hidden && this.stopAll());
    app.link.on("close", () => this.#forget());
    // A button that becomes disabled under the finger may never hear that it was let go.
    app.store.watch(GATE_KEYS, (v) => whyNotManual(v) && this.stopAll());
  }

  /** Speed of jogs in machine units per minute. @param {"linear" | "angular"} kind */
  speedPerMin(kind) {
    const limits = this.app.v.config.jog_speed[kind];
    const wanted = recall(`jog.${kind}`, limits.default_per_min);
    return Math.min(Math.max(wanted, limits.min_per_min), limits.max_per_min);
  }

  /** @param {"linear" | "angular"} kind @param {number} perMin */
  setSpeed(kind, perMin) {
    remember(`jog.${kind}`, perMin);
  }

  /**
   * What is jogged for one axis: the axis once all is homed, before that the joint that moves it.
   * @param {any} axis an entry of `config.axes` @returns {Target}
   */
  target(axis) {
    return this.app.v.all_homed ? { axis: axis.letter } : { joint: axis.joints[0] };
  }

  /** Velocity of a target, machine units per second. @param {boolean} linear @param {number} direction @param {boolean} [fast] */
  velocity(linear, direction, fast = false) {
    const kind = linear ? "linear" : "angular";
    const perMin = fast ? this.app.v.config.jog_speed[kind].max_per_min : this.speedPerMin(kind);
    return (direction * perMin) / 60;
  }

  /** The chosen step, machine units or degrees; null: continuous. @param {boolean} linear @returns {number | null} */
  increment(linear) {
    return this.app.v[linear ? "increment_linear" : "increment_angular"] ?? null;
  }

  /**
   * Begin a jog that lasts until `release(holder)`.
   * @param {string} holder @param {Target} target @param {number} velocity signed
   */
  async hold(holder, target, velocity) {
    if (this.#holds.has(holder) || whyNotManual(this.app.v)) return;
    /** @type {Hold} */
    const hold = { target, jog: null, released: false };
    this.#holds.set(holder, hold);
    try {
      const { jog } = await this.app.call("jog.start", { ...target, velocity });
      hold.jog = jog;
      if (hold.released) this.app.act("jog.stop", { jog });
      else this.#beat();
    } catch {
      if (this.#holds.get(holder) === hold) this.#holds.delete(holder);
    }
  }

  /** Change the speed of what is held; a stick calls this. @param {string} holder @param {number} velocity */
  change(holder, velocity) {
    const hold = this.#holds.get(holder);
    if (hold?.jog != null) this.app.act("jog.velocity", { jog: hold.jog, velocity });
  }

  /** @param {string} holder */
  release(holder) {
    const hold = this.#holds.get(holder);
    if (!hold) return;
    this.#holds.delete(holder);
    hold.released = true;
    if (hold.jog !== null) this.app.act("jog.stop", { jog: hold.jog });
  }

  /** Whether this holder has a jog under way. @param {string} holder */
  holding(holder) {
    return this.#holds.has(holder);
  }

  /** Let go of everything; also when nothing is held here, if the server knows of a jog. */
  stopAll() {
    for (const holder of [...this.#holds.keys()]) this.release(holder);
  }

  /**
   * What a press of a button or key does: one step, or a jog that lasts until `release(holder)`.
   * @param {string} holder @param {Target} target @param {number} velocity signed
   * @param {number | null} increment null: continuous
   */
  press(holder, target, velocity, increment) {
    if (increment === null) this.hold(holder, target, velocity);
    else this.step(target, Math.abs(velocity), Math.sign(velocity) * increment);
  }

  /** One step. @param {Target} target @param {number} velocity positive @param {number} distance signed */
  step(target, velocity, distance) {
    return this.app.act("jog.step", { ...target, velocity, distance });
  }

  #forget() {
    for (const hold of this.#holds.values()) hold.released = true;
    this.#holds.clear();
    this.#beat();
  }

  /** Send beats for whatever is held, and go on as long as something is. */
  #beat() {
    clearInterval(this.#timer);
    this.#timer = undefined;
    if (this.#holds.size === 0) return;
    const send = () => {
      if (this.#holds.size === 0) return this.#beat();
      for (const hold of this.#holds.values()) if (hold.jog !== null) this.app.link.beat(hold.jog);
    };
    send();
    this.#timer = setInterval(send, this.app.v.config.jog_heartbeat.interval * 1000);
  }
}

/**
 * Make a button jog: continuous while it is held, or one step at each press, as the operator chose.
 * @param {HTMLButtonElement} button @param {import("./app.js").App} app @param {string} holder
 * @param {() => {target: Target, velocity: number, increment: number | null}} wanted asked at each press
 */
export function jogButton(button, app, holder, wanted) {
  const start = () => {
    const { target, velocity, increment } = wanted();
    app.jogger.press(holder, target, velocity, increment);
  };
  button.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || button.disabled) return;
    button.setPointerCapture(event.pointerId);
    start();
  });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) {
    button.addEventListener(end, () => app.jogger.release(holder));
  }
  button.addEventListener("contextmenu", (event) => event.preventDefault());
  button.addEventListener("keydown", (event) => {
    if (event.repeat || (event.key !== " " && event.key !== "Enter")) return;
    event.preventDefault();
    start();
  });
  button.addEventListener("keyup", () => app.jogger.release(holder));
}
