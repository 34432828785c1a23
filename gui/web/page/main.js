/** The page's beginning: connects, fills the store from the server's frames, builds frame and panels. */

import { App } from "./core/app.js";
import { h, fill, setFlag, setText } from "./core/dom.js";
import { _, language, loadLanguage } from "./core/i18n.js";
import { Jogger } from "./core/jog.js";
import { Link } from "./core/link.js";
import { operator, running } from "./core/machine.js";
import { Panels } from "./core/panels.js";
import { keepOnServer, recall, remember } from "./core/prefs.js";
import { Store } from "./core/store.js";
import { setToken, token } from "./core/token.js";
import { activeCodes } from "./frame/codes.js";
import { mountHeader, setTheme } from "./frame/header.js";
import { overrides } from "./frame/overrides.js";
import { watchPrompts } from "./frame/prompts.js";
import { readout } from "./frame/readout.js";
import { mountRunbar } from "./frame/runbar.js";
import { registerEmbedded } from "./panels/embed.js";
import "./panels/index.js";

const MESSAGES_KEPT = 500;

const store = new Store();
const secret = token();
await loadLanguage(recall("language", navigator.language));
const link = new Link(() => ({ token: recall("token", secret), name: recall("name", "") || deviceName(), lang: language }));
const app = new App(store, link);
setTheme(app, recall("theme", "dark"));
app.jogger = new Jogger(app);
app.panels = new Panels(app);
let built = false;

link.on("hello", (frame) => {
  store.merge({
    ...frame.status, config: frame.config, me: { client: frame.client, role: frame.role }, link: true,
    message_list: frame.messages ?? [], mdi_history: frame.history ?? [],
  });
  keepOnServer(frame.preferences ?? {}, (values) => operator(store.values) && link.call("preferences.write", { values }).catch(() => {}));
  if (!built) build(frame.config);
  if (operator(store.values) && !store.values.control && !document.hidden && !frame.config.wizard) link.call("control.take").catch(() => {});
});
link.on("status", (frame) => store.merge(frame.s));
link.on("message", (message) => {
  store.merge({
    message_list: [...(store.values.message_list ?? []), message].slice(-MESSAGES_KEPT),
    unread: app.panels.isVisible("messages") ? 0 : (store.values.unread ?? 0) + (message.kind === "notice" ? 0 : 1),
  });
  app.notify(message.kind, message.text);
});
link.on("close", ({ code }) => store.merge({ link: false, closed: code }));
store.watch(["link", "machine", "closed"], showConnection);
link.connect();

/** @param {any} config */
function build(config) {
  built = true;
  document.title = config.title || config.machine || "pyemc";
  if (config.icon) document.querySelector("link[rel=icon]")?.setAttribute("href", config.icon);
  registerEmbedded(config.embed_tabs ?? []);
  const place = (/** @type {string} */ id) => /** @type {HTMLElement} */ (document.getElementById(id));
  if (config.wizard) document.body.dataset.wizard = "";
  else {
    mountHeader(place("head"), app);
    place("side").setAttribute("aria-label", _("Position and overrides"));
    fill(place("side"), readout(app), overrides(app), activeCodes(app));
    mountRunbar(place("foot"), app);
    watchPrompts(app);
  }
  if (config.confirm_exit) addEventListener("beforeunload", (event) => running(store.values) && event.preventDefault());
  app.panels.start();
}

/** Cover the page while its numbers are old. @param {any} v */
function showConnection(v) {
  const cover = /** @type {HTMLElement} */ (document.getElementById("offline"));
  const lost = v.link === false || (v.link && v.machine !== undefined && v.machine !== "ok" && !v.config?.wizard);
  setFlag(cover, "hidden", !lost);
  if (!lost) return;
  if (v.link === false && v.closed === 4401) return askToken(cover);
  const title = v.link === false ? _("No connection") : _("Machine cannot be reached");
  const text = v.link === false ? _("The page tries to connect again. A jog that was under way has been stopped by the machine.") : v.machine;
  const heading = h("h2", { id: "offline-title" });
  setText(heading, title);
  cover.setAttribute("aria-labelledby", "offline-title");
  fill(cover, h("div", { class: "card stack" }, heading, h("p", null, text), h("p", { class: "muted" }, _("All numbers on this page are old."))));
}

/** @param {HTMLElement} cover */
function askToken(cover) {
  const input = h("input", { type: "password", "aria-label": _("Token"), autocomplete: "current-password", class: "grow" });
  const submit = (/** @type {Event} */ event) => {
    event.preventDefault();
    setToken(input.value.trim());
    link.again();
  };
  cover.setAttribute("aria-label", _("Token"));
  fill(cover, h("form", { class: "card stack", onsubmit: submit }, h("h2", null, _("This machine asks for a token")), h("div", { class: "row" }, input, h("button", { type: "submit", class: "primary" }, _("Connect")))));
  input.focus();
}

/** A name that others can tell this screen by, until its operator gives it a better one. */
function deviceName() {
  const kind = /Android|iPhone/.test(navigator.userAgent) ? _("Phone") : /iPad|Tablet/.test(navigator.userAgent) ? _("Tablet") : _("Screen");
  const number = recall("number", 0) || Math.floor(Math.random() * 90) + 10;
  remember("number", number);
  return `${kind} ${number}`;
}
