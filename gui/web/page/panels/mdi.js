/** The MDI panel: one line of G-code at a time, checked before it is sent, with history. */

import { fill, h, setAttribute, setText } from "../core/dom.js";
import { confirm } from "../core/dialog.js";
import { _ } from "../core/i18n.js";
import { icon } from "../core/icons.js";
import { idle, operator, whyNoControl, whyNotHomed, whyNoPower } from "../core/machine.js";
import { registerPanel } from "../core/panels.js";

/** @typedef {import("../core/app.js").App} App */

const CHECK_PAUSE_MS = 250;
const ERASE = "⌫";
const KEYS = ["G", "M", "X", "7", "8", "9", ERASE, "F", "S", "Y", "4", "5", "6", "-", "I", "J", "Z", "1", "2", "3", ".", "G0", "G1", "T", "0"];

registerPanel({
  id: "mdi",
  title: () => _("MDI"),
  icon: "mdi",
  order: 30,
  beside: "path",
  mount(root, app) {
    const why = (/** @type {any} */ v) => whyNoControl(v) || whyNoPower(v) || (v.task_mode === 2 && !idle(v) ? _("A program is running") : whyNotHomed({ ...v, interp_state: 1 }));
    const verdict = h("p", { class: "verdict", role: "status" });
    const input = h("input", {
      type: "text", class: "code grow", id: "mdi-line", "aria-label": _("MDI line"), autocomplete: "off", autocapitalize: "characters", spellcheck: "false", enterkeyhint: "send",
      placeholder: "G0 X10 Y5",
    });
    const check = lineCheck(app, input, verdict);
    const list = historyList(app, input, check);
    const send = async () => {
      const text = input.value.trim();
      if (!text || !(await check.now())) return;
      input.value = "";
      check.clear();
      list.add(text);
      app.act("mdi.run", { text });
    };
    const button = app.button("play", _("Send"), send, why, { class: "go", id: "mdi-send" });
    input.addEventListener("input", check.later);
    input.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
      if (event.key === "Enter" && !button.disabled) send();
      else if (event.key === "ArrowUp" || event.key === "ArrowDown") {
        event.preventDefault();
        list.browse(event.key === "ArrowUp" ? -1 : 1);
      }
    });
    const queued = h("span", { class: "muted" });
    app.store.watch(["queued_mdi_commands", "command", "interp_state"], (v) =>
      setText(queued, idle(v) ? "" : `${v.command ?? ""} ${v.queued_mdi_commands ? _("({n} waiting)", { n: v.queued_mdi_commands }) : ""}`),
    );
    fill(
      root,
      h("div", { class: "card stack" }, h("h2", null, _("Line"), " ", queued), h("div", { class: "row nowrap" }, input, button), verdict, keyPad(input, check.later)),
      h("div", { class: "card stack grow" }, h("div", { class: "row" }, h("h2", { class: "heading grow" }, _("History")), list.clearButton), list.element),
    );
    return { show: () => input.focus({ preventScroll: true }) };
  },
});

/** Words for gloves and touch screens. @param {HTMLInputElement} input @param {() => void} changed */
function keyPad(input, changed) {
  const insert = (/** @type {string} */ key) => {
    const word = /[A-Z]/.test(key) && input.value && !input.value.endsWith(" ");
    input.setRangeText((word ? " " : "") + key, input.selectionStart ?? 0, input.selectionEnd ?? 0, "end");
    changed();
  };
  const erase = () => {
    const at = input.selectionStart ?? 0;
    input.setRangeText("", input.selectionStart === input.selectionEnd ? Math.max(at - 1, 0) : at, input.selectionEnd ?? at, "end");
    changed();
  };
  const keep = { onpointerdown: (/** @type {Event} */ event) => event.preventDefault() }; // the line keeps the focus
  return h(
    "div",
    { class: "keypad" },
    KEYS.map((key) => h("button", { type: "button", onclick: () => (key === ERASE ? erase() : insert(key)), "aria-label": key === ERASE ? _("Delete") : null, ...keep }, key)),
    h("button", { type: "button", class: "wide", onclick: () => insert(" "), ...keep }, _("Space")),
  );
}

/** Ask the server what a line would do, a moment after the last key. @param {App} app @param {HTMLInputElement} input @param {HTMLElement} verdict */
function lineCheck(app, input, verdict) {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  const show = (/** @type {string} */ kind, /** @type {string} */ text) => {
    setAttribute(verdict, "data-kind", kind);
    setText(verdict, text);
    setAttribute(input, "aria-invalid", String(kind === "danger"));
  };
  const now = async () => {
    clearTimeout(timer);
    const text = input.value.trim();
    if (!text) return show("", ""), false;
    try {
      const found = await app.link.call("mdi.check", { text });
      if (input.value.trim() !== text) return false;
      const outside = found.outside ?? [];
      show(outside.length ? "warn" : "ok", outside.length ? leaving(outside) : _("Checked, {n} moves", { n: found.moves }));
      return true;
    } catch (error) {
      if (input.value.trim() !== text) return false;
      const { code, details, message } = /** @type {any} */ (error);
      const wrong = code === "gcode";
      show(wrong ? "danger" : "warn", details?.column ? _("Column {column}: {text}", { column: details.column, text: message }) : message);
      return !wrong; // what cannot be checked may be sent; the machine checks it too
    }
  };
  return {
    now,
    later() {
      clearTimeout(timer);
      timer = setTimeout(now, CHECK_PAUSE_MS);
    },
    clear() {
      clearTimeout(timer);
      show("", "");
    },
  };
}

/** @param {any[]} outside */
function leaving(outside) {
  return _("Leaves the machine's limits: {axes}", { axes: outside.map((one) => `${one.axis} ${Number(one.value).toFixed(3)}`).join(", ") });
}

/** @param {App} app @param {HTMLInputElement} input @param {{later: () => void}} check */
function historyList(app, input, check) {
  const element = h("div", { class: "scroll history", role: "list", "aria-label": _("History") });
  /** @type {string[]} */
  let lines = [];
  let at = 0;
  const take = (/** @type {string} */ text) => {
    input.value = text;
    input.focus();
    check.later();
  };
  const draw = () => {
    at = lines.length;
    fill(element, [...lines].reverse().map((text) => h("div", { role: "listitem" }, h("button", { type: "button", class: "plain mono", onclick: () => take(text) }, text))));
  };
  const clearButton = app.gate(
    h("button", { type: "button", class: "plain", onclick: () => clear(), "aria-label": _("Clear the history") }, icon("trash")),
    (v) => (operator(v) ? "" : _("You may watch only")),
  );
  const clear = async () => {
    if ((await confirm(_("History"), _("Forget all lines?"), _("Forget"), "danger")) && (await app.act("mdi.history_clear"))) {
      lines = [];
      draw();
    }
  };
  app.store.watch(["mdi_history"], (v) => {
    lines = [...(v.mdi_history ?? [])];
    draw();
  });
  return {
    element,
    clearButton,
    add(/** @type {string} */ text) {
      lines.push(text);
      draw();
    },
    browse(/** @type {number} */ step) {
      at = Math.min(Math.max(at + step, 0), lines.length);
      input.value = lines[at] ?? "";
      check.later();
    },
  };
}
