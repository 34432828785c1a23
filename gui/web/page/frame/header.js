/** The header: E-stop and power, the machine's state, who has the controls, messages, theme and language. */

import { field, fill, h, select, setAttribute, setFlag, setPressed, setText } from "../core/dom.js";
import { confirm, openDialog } from "../core/dialog.js";
import { _, language } from "../core/i18n.js";
import { icon, iconButton } from "../core/icons.js";
import { estopped, inControl, modeInWords, operator, powered, stateInWords, whyNoControl } from "../core/machine.js";
import { recall, remember } from "../core/prefs.js";
import { chooseUnits, unitChoice } from "../core/units.js";

/** @typedef {import("../core/app.js").App} App */

/** @param {HTMLElement} root @param {App} app */
export function mountHeader(root, app) {
  const operatorButton = operatorControl(app);
  fill(
    root,
    estopButton(app),
    powerButton(app),
    stateDisplay(app),
    operatorButton,
    messagesButton(app),
    iconButton("setup", _("Display settings"), () => settings(app), { iconOnly: true, class: "plain", id: "settings" }),
  );
}

/** Stopping needs no controls, resetting does. @param {App} app */
function estopButton(app) {
  const text = h("span", null, _("E-STOP"));
  const button = h(
    "button",
    { type: "button", id: "estop", onclick: () => app.act(estopped(app.v) ? "machine.estop_reset" : "machine.estop") },
    icon("estop"),
    text,
  );
  app.gate(button, (v) => {
    if (!v.link) return _("No connection");
    return estopped(v) ? whyNoControl(v) : operator(v) ? "" : _("You may watch only");
  });
  app.store.watch(["task_state"], (v) => {
    setPressed(button, estopped(v));
    setText(text, estopped(v) ? _("Reset E-stop") : _("E-STOP"));
  });
  return button;
}

/** @param {App} app */
function powerButton(app) {
  const button = app.button(
    "power",
    _("Power"),
    () => app.act("machine.power", { on: !powered(app.v) }),
    (v) => whyNoControl(v) || (estopped(v) ? _("The machine is in E-stop") : ""),
    { id: "power" },
  );
  app.store.watch(["task_state"], (v) => setPressed(button, powered(v)));
  return button;
}

/** @param {App} app */
function stateDisplay(app) {
  const line = h("div", { id: "state-line", role: "status" });
  const detail = h("div", { id: "detail-line" });
  const title = h("h1", { class: "visually-hidden" });
  app.store.watch(
    ["link", "machine", "task_state", "task_mode", "interp_state", "paused", "task_paused", "all_homed", "homing", "toolchange", "program", "config"],
    (v) => {
      const state = stateInWords(v);
      setText(title, v.config?.title ?? "");
      setText(line, state.text);
      setAttribute(line, "data-kind", state.kind);
      setText(detail, [v.config?.title || v.config?.machine, modeInWords(v), v.program?.name].filter(Boolean).join(" · "));
    },
  );
  return h("div", { id: "state" }, title, line, detail);
}

/** Who has the controls; pressing it takes, asks for or releases them. @param {App} app */
function operatorControl(app) {
  const text = h("span");
  const button = h("button", { type: "button", id: "operator", onclick: () => controlDialog(app) }, icon("user"), text);
  app.store.watch(["control", "me", "link"], (v) => {
    const mine = inControl(v);
    const words = !v.link ? "–" : !operator(v) ? _("Watching") : mine ? _("You have the controls") : v.control ? v.control.name : _("Take the controls");
    setText(text, words);
    setAttribute(button, "aria-label", words);
    setAttribute(button, "class", mine || !operator(v) ? "" : "primary");
  });
  app.store.watch(["control_request"], (v) => {
    if (v.control_request && inControl(v) && v.control_request.client !== v.me.client) handOver(app, v.control_request);
  });
  return button;
}

/** @param {App} app @param {{client: number, name: string}} request */
async function handOver(app, request) {
  const yes = await confirm(_("Controls"), _("{name} asks for the controls.", { name: request.name }), _("Hand over"));
  if (yes) app.act("control.hand", { client: request.client });
}

/** @param {App} app */
async function controlDialog(app) {
  const { v } = app;
  if (!operator(v)) return app.notify("notice", _("This browser may watch only: it was opened without an operator's token."));
  if (!v.control) return void app.act("control.take");
  if (inControl(v)) {
    if (await confirm(_("Controls"), _("Release the controls, so that somebody else can take them?"), _("Release"))) app.act("control.release");
    return;
  }
  openDialog(
    _("Controls"),
    [h("p", null, _("{name} has the controls.", { name: v.control.name }))],
    [
      { text: _("Cancel") },
      {
        text: _("Take them anyway"),
        kind: "danger",
        act: (close) => {
          close();
          app.act("control.take", { force: true });
        },
      },
      {
        text: _("Ask for them"),
        kind: "primary",
        act: (close) => {
          close();
          app.act("control.request");
        },
      },
    ],
  );
}

/** @param {App} app */
function messagesButton(app) {
  const badge = h("span", { class: "badge", hidden: true });
  const button = h("button", { type: "button", class: "plain", id: "messages", "aria-label": _("Messages"), onclick: () => app.panels.show("messages") }, icon("messages"), badge);
  app.store.watch(["unread"], (v) => {
    setFlag(badge, "hidden", !v.unread);
    setText(badge, String(v.unread ?? ""));
  });
  return button;
}

/** @param {App} app */
function settings(app) {
  const { config } = app.v;
  const units = select(
    [["auto", _("As the program")], ["mm", "mm"], ["inch", "inch"]],
    unitChoice(),
    (choice) => {
      chooseUnits(choice);
      app.store.merge({ unit_choice: choice });
    },
  );
  const theme = select([["dark", _("Dark")], ["light", _("Light")]], recall("theme", "dark"), (choice) => setTheme(app, choice));
  const languages = select(config.languages.map((/** @type {any} */ one) => [one.code, one.name]), language, (choice) => {
    remember("language", choice);
    location.reload();
  });
  const name = h("input", { type: "text", value: recall("name", ""), maxlength: 40, onchange: () => remember("name", name.value.trim()) });
  openDialog(
    _("Display settings"),
    [
      field(_("Theme"), theme),
      field(_("Language"), languages),
      field(_("Lengths"), units),
      field(_("Name of this screen"), name),
      h("p", { class: "muted" }, _("Others see this name when this screen has the controls. It takes effect when the page is loaded again.")),
      h("p", { class: "muted mono" }, `${config.ini ?? ""}`),
    ],
    [{ text: _("Close"), kind: "primary", submit: true }],
  );
}

/** @param {App} app @param {string} theme */
export function setTheme(app, theme) {
  remember("theme", theme);
  document.documentElement.dataset.theme = theme;
  app.store.merge({ theme });
}
