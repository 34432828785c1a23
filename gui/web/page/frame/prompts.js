/** Dialogs that the machine opens: a tool to be changed by hand, and messages that HAL pins ask for. */

import { h } from "../core/dom.js";
import { openDialog } from "../core/dialog.js";
import { _ } from "../core/i18n.js";
import { inControl, whyNoControl } from "../core/machine.js";

/** @typedef {import("../core/app.js").App} App */

/** @param {App} app */
export function watchPrompts(app) {
  watchToolChange(app);
  watchDialogs(app);
}

/** @param {App} app */
function watchToolChange(app) {
  /** @type {{close: () => void} | null} */
  let open = null;
  let shown = "";
  app.store.watch(["toolchange", "control"], (v) => {
    const key = v.toolchange ? `${v.toolchange.tool}/${inControl(v)}` : "";
    if (key === shown) return;
    shown = key;
    open?.close();
    open = null;
    if (!v.toolchange) return;
    const { tool, text } = v.toolchange;
    open = openDialog(
      tool ? _("Insert tool {tool}", { tool }) : _("Remove the tool"),
      [
        h("p", { class: "tool-number" }, tool ? `T${tool}` : "–"),
        text ? h("p", null, text) : null,
        inControl(v) ? h("p", { class: "muted" }, _("The program waits until you confirm.")) : h("p", { class: "notice" }, whyNoControl(v)),
      ],
      [
        { text: _("Stop the program"), kind: "danger", act: () => app.act("machine.abort") },
        ...(inControl(v) ? [{ text: tool ? _("Tool is in") : _("Tool is out"), kind: "go", submit: true, act: () => app.act("toolchange.confirm") }] : []),
      ],
      { fixed: true },
    );
  });
}

/** @param {App} app */
function watchDialogs(app) {
  /** @type {Map<string, {close: () => void}>} */
  const open = new Map();
  app.store.watch(["dialogs"], (v) => {
    const wanted = new Map((v.dialogs ?? []).map((/** @type {any} */ one) => [one.id, one]));
    for (const [id, dialog] of open) {
      if (wanted.has(id)) continue;
      dialog.close();
      open.delete(id);
    }
    for (const [id, one] of wanted) {
      if (open.has(id)) continue;
      open.set(id, one.kind === "status" ? statusNotice(one) : question(app, one));
    }
  });
}

/** @param {App} app @param {any} dialog */
function question(app, dialog) {
  const answer = (/** @type {boolean} */ value) => app.act("dialog.answer", { id: dialog.id, answer: value });
  const actions =
    dialog.kind === "yesno"
      ? [{ text: _("No"), act: () => answer(false) }, { text: _("Yes"), kind: "primary", submit: true, act: () => answer(true) }]
      : [{ text: _("OK"), kind: "primary", submit: true, act: () => answer(true) }];
  return openDialog(dialog.title || _("Message"), [h("p", null, dialog.text), dialog.details ? h("p", { class: "muted" }, dialog.details) : null], actions, { fixed: true });
}

/** A line that stays as long as its pin is set. @param {any} dialog */
function statusNotice(dialog) {
  const notice = h("div", { class: "notice", data: { dialog: dialog.id } }, h("p", null, h("strong", null, dialog.title || ""), " ", dialog.text));
  document.getElementById("toasts")?.append(notice);
  return { close: () => notice.remove() };
}
