/** The manual panel: homing, jogging, touch-off, spindle, coolant and the integrator's MDI buttons. */

import { fill, h, select, setPressed, setText } from "../core/dom.js";
import { _ } from "../core/i18n.js";
import { icon } from "../core/icons.js";
import { jogButton } from "../core/jog.js";
import { openDialog } from "../core/dialog.js";
import { homingNow, whyNoControl, whyNoPower, whyNotHomed, whyNotManual } from "../core/machine.js";
import { registerPanel } from "../core/panels.js";
import { recall, remember } from "../core/prefs.js";
import { displayUnit, fixed, scale } from "../core/units.js";
import { spindleCard, coolantCard } from "./spindle.js";
import { touchOffAxis, touchOffTool } from "./touchoff.js";
import { inputSwitches } from "./jogdevices.js";

/** @typedef {import("../core/app.js").App} App */

/** Where the buttons of the pad lie: grid area and arrow for each axis letter, minus and plus. */
const MILL_PAD = { X: ["xm", "left", "xp", "right"], Y: ["ym", "down", "yp", "up"], Z: ["zm", "down", "zp", "up"] };
const FRONT_LATHE_PAD = { X: ["ym", "up", "yp", "down"], Z: ["xm", "left", "xp", "right"] };
const BACK_LATHE_PAD = { X: ["ym", "down", "yp", "up"], Z: ["xm", "left", "xp", "right"] };
const FOAM_PAD = { X: ["xm", "left", "xp", "right"], Y: ["ym", "down", "yp", "up"] };
const FOAM_TOP_PAD = { U: ["xm", "left", "xp", "right"], V: ["ym", "down", "yp", "up"] };

registerPanel({
  id: "manual",
  title: () => _("Manual"),
  icon: "manual",
  order: 10,
  beside: "path",
  mount(root, app) {
    const { config } = app.v;
    fill(
      root,
      h("div", { class: "card stack" }, homing(app), touchOff(app, config)),
      jogging(app, config),
      h("div", { class: "grid two" }, ...config.spindles.map((/** @type {any} */ _limits, /** @type {number} */ n) => spindleCard(app, n)), coolantCard(app)),
      config.mdi_commands?.length ? mdiButtons(app, config.mdi_commands) : null,
    );
  },
});

/** @param {App} app */
function homing(app) {
  const { config } = app.v;
  const why = (/** @type {any} */ v) => whyNotManual(v) || (homingNow(v) ? _("Homing is under way") : "");
  const all = app.button("home", _("Home all"), () => app.act("home", { joint: -1 }), why, { id: "home-all", class: "primary" });
  const single = config.joints.map((/** @type {any} */ joint) => {
    const name = config.identity ? joint.axis : `J${joint.number}`;
    const button = app.button("", name, () => homeJoint(app, joint.number, name), why, { data: { joint: joint.number }, "aria-label": _("Home {name}", { name }) });
    app.store.watch(["homed"], (v) => button.classList.toggle("homed", Boolean(v.homed?.[joint.number])));
    return button;
  });
  app.store.watch(["all_homed"], (v) => all.classList.toggle("primary", !v.all_homed));
  return h("div", { class: "row homing", role: "group", "aria-label": _("Homing") }, all, ...single);
}

/** @param {App} app @param {number} joint @param {string} name */
function homeJoint(app, joint, name) {
  if (!app.v.homed[joint]) {
    app.act("home", { joint });
    return;
  }
  const choose = (/** @type {string} */ method) => (/** @type {() => void} */ close) => {
    close();
    app.act(method, { joint });
  };
  openDialog(
    _("Homing"),
    [h("p", null, _("{name} is homed. Home it again?", { name }))],
    [{ text: _("Cancel") }, { text: _("Forget its home"), kind: "danger", act: choose("unhome") }, { text: _("Home"), kind: "primary", submit: true, act: choose("home") }],
  );
}

/** @param {App} app @param {any} config */
function jogging(app, config) {
  const pads = padsOf(config).map((pad) => jogPad(app, config, pad));
  const inPads = new Set(padsOf(config).flatMap((pad) => Object.keys(pad)));
  const others = config.axes.filter((/** @type {any} */ axis) => !inPads.has(axis.letter));
  const rows = others.map((/** @type {any} */ axis) => jogRow(app, axis));
  const free = config.identity ? [] : [jointJog(app, config)];
  const limits = app.button("", _("Override limits"), () => app.act("override_limits"), (v) => whyNoControl(v) || whyNoPower(v) || ((v.limit ?? []).some(Boolean) ? "" : _("No joint is on a limit")));
  return h(
    "div",
    { class: "card jogging", role: "group", "aria-label": _("Jog") },
    ...kindsOf(config).map((kind) => incrementButtons(app, config, kind)),
    ...pads,
    ...rows,
    ...free,
    ...speedSliders(app, config),
    h("div", { class: "row switches" }, inputSwitches(app), limits),
  );
}

/** @param {any} config @returns {Record<string, string[]>[]} */
function padsOf(config) {
  if (config.machine_type === "lathe") return [config.back_tool_lathe ? BACK_LATHE_PAD : FRONT_LATHE_PAD];
  if (config.machine_type === "foam") return [FOAM_PAD, FOAM_TOP_PAD];
  return [MILL_PAD];
}

/** The kinds of axes that there are. @param {any} config */
function kindsOf(config) {
  const kinds = /** @type {const} */ (["linear", "angular"]);
  return kinds.filter((kind) => config.axes.some((/** @type {any} */ axis) => axis.linear === (kind === "linear")));
}

/** @param {App} app @param {any} config @param {"linear" | "angular"} kind */
function incrementButtons(app, config, kind) {
  const increments = kind === "linear" ? config.increments : config.angular_increments;
  const chosen = increments[recall(`increment.${kind}`, 0)] ?? increments[0];
  app.store.merge({ [`increment_${kind}`]: chosen.value });
  const buttons = increments.map((/** @type {any} */ increment, /** @type {number} */ n) =>
    h(
      "button",
      {
        type: "button",
        "aria-pressed": String(increment === chosen),
        "aria-label": increment.value === null ? _("Continuous, as long as the button is held") : null,
        onclick: () => {
          app.store.merge({ [`increment_${kind}`]: increment.value });
          remember(`increment.${kind}`, n);
          buttons.forEach((/** @type {any} */ button, /** @type {number} */ k) => setPressed(button, k === n));
        },
      },
      increment.value === null ? _("Hold") : increment.text,
    ),
  );
  return h("div", { class: "segments increments", role: "group", "aria-label": kind === "linear" ? _("Jog increment") : _("Turning increment") }, buttons);
}

/** @param {App} app @param {any} config @param {Record<string, string[]>} pad */
function jogPad(app, config, pad) {
  const axes = config.axes.filter((/** @type {any} */ axis) => pad[axis.letter]);
  const buttons = axes.flatMap((/** @type {any} */ axis) => {
    const [minusArea, minusArrow, plusArea, plusArrow] = pad[axis.letter];
    return [jogKey(app, axis, -1, minusArrow, minusArea), jogKey(app, axis, 1, plusArrow, plusArea)];
  });
  return h("div", { class: `jogpad ${axes.some((/** @type {any} */ axis) => pad[axis.letter][0] === "zm") ? "with-z" : ""}` }, buttons);
}

/** @param {App} app @param {any} axis */
function jogRow(app, axis) {
  return h("div", { class: "jogrow" }, jogKey(app, axis, -1, "left", ""), jogKey(app, axis, 1, "right", ""));
}

/**
 * @param {App} app @param {any} axis @param {number} direction
 * @param {string} arrow @param {string} area
 */
function jogKey(app, axis, direction, arrow, area) {
  const sign = direction < 0 ? "−" : "+";
  const button = app.button(arrow, `${axis.letter}${sign}`, () => {}, whyNotManual, {
    class: "jog", data: { jog: `${axis.letter}${direction < 0 ? "-" : "+"}` }, "aria-label": _("Jog {axis}", { axis: `${axis.letter} ${sign}` }),
    style: area ? { gridArea: area } : {},
  });
  jogButton(button, app, `button:${axis.letter}${sign}`, () => ({
    target: app.jogger.target(axis), velocity: app.jogger.velocity(axis.linear, direction), increment: app.jogger.increment(axis.linear),
  }));
  return button;
}

/** Joints one by one, where axes are not joints: before homing nothing else can be moved. @param {App} app @param {any} config */
function jointJog(app, config) {
  let joint = config.joints[0];
  const chooser = select(config.joints.map((/** @type {any} */ one) => [one.number, `J${one.number}`]), 0, (value) => (joint = config.joints[Number(value)]), { "aria-label": _("Joint") });
  const key = (/** @type {number} */ direction) => {
    const button = app.button(direction < 0 ? "left" : "right", `J${direction < 0 ? "−" : "+"}`, () => {}, (v) => whyNotManual(v), { class: "jog" });
    jogButton(button, app, `joint:${direction}`, () => ({
      target: { joint: joint.number }, velocity: app.jogger.velocity(joint.linear, direction), increment: app.jogger.increment(joint.linear),
    }));
    return button;
  };
  return h("div", { class: "jogrow" }, chooser, key(-1), key(1));
}

/** @param {App} app @param {any} config */
function speedSliders(app, config) {
  return kindsOf(config).map((kind) => speedSlider(app, kind, config.jog_speed[kind]));
}

/** Jog speed on a logarithmic slider, because 10 and 10000 are equally useful. @param {App} app @param {any} kind @param {any} limits */
function speedSlider(app, kind, limits) {
  const low = Math.max(limits.min_per_min, limits.max_per_min / 1000);
  const span = Math.log(limits.max_per_min / low);
  const shown = h("output", { class: "mono" });
  const show = (/** @type {any} */ v) => {
    const speed = app.jogger.speedPerMin(kind);
    setText(shown, kind === "linear" ? `${fixed(speed * scale(v), speed * scale(v) < 10 ? 1 : 0)} ${displayUnit(v)}/min` : `${fixed(speed, 0)} °/min`);
  };
  const label = kind === "linear" ? _("Jog speed") : _("Turning speed");
  const input = h("input", {
    type: "range", min: 0, max: 1, step: 0.01, "aria-label": label,
    value: Math.log(Math.max(app.jogger.speedPerMin(kind), low) / low) / span,
    oninput: () => {
      app.jogger.setSpeed(kind, low * Math.exp(span * input.valueAsNumber));
      show(app.v);
    },
  });
  app.store.watch(["program_units", "unit_choice"], show);
  return h("div", { class: "override" }, h("span", { class: "label" }, h("span", null, label), shown), input);
}

/** @param {App} app @param {any} config */
function touchOff(app, config) {
  const why = (/** @type {any} */ v) => whyNotHomed(v);
  const axes = config.axes.map((/** @type {any} */ axis) =>
    app.button("", axis.letter, () => touchOffAxis(app, axis), why, { "aria-label": _("Touch off {axis}", { axis: axis.letter }), data: { touchoff: axis.letter } }),
  );
  const tool = app.button("", _("Tool"), () => touchOffTool(app), (v) => why(v) || (v.tool_in_spindle ? "" : _("No tool is loaded")), { "aria-label": _("Touch off the tool"), data: { touchoff: "tool" } });
  return h("div", { class: "row touchoff", role: "group", "aria-label": _("Touch off") }, h("span", { class: "name" }, icon("touchoff"), _("Touch off")), ...axes, tool);
}

/** @param {App} app @param {any[]} commands */
function mdiButtons(app, commands) {
  const buttons = commands.map((command) => app.button("", command.label, () => app.act("mdi.command", { index: command.index }), whyNotHomed, { class: "mdi-command" }));
  return h("div", { class: "card" }, h("h2", null, _("Commands")), h("div", { class: "row" }, buttons));
}
