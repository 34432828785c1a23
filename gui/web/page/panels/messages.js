/** The messages panel: everything the machine and the display have said, newest first. */

import { fill, h, setAttribute } from "../core/dom.js";
import { _ } from "../core/i18n.js";
import { iconButton } from "../core/icons.js";
import { registerPanel } from "../core/panels.js";
import { clock } from "../core/units.js";

const KINDS = /** @type {Record<string, () => string>} */ ({
  error: () => _("Error"),
  text: () => _("Note"),
  display: () => _("Program"),
  notice: () => _("Display"),
});

registerPanel({
  id: "messages",
  title: () => _("Messages"),
  icon: "messages",
  order: 60,
  mount(root, app) {
    const list = h("div", { class: "scroll grow message-list", role: "list" });
    let only = "";
    const filters = [["", _("All")], ["error", _("Errors")], ["display", _("From programs")]].map(([kind, text]) =>
      h("button", { type: "button", "aria-pressed": String(kind === only), data: { kind }, onclick: () => choose(kind) }, text),
    );
    const choose = (/** @type {string} */ kind) => {
      only = kind;
      for (const button of filters) setAttribute(button, "aria-pressed", String(button.dataset.kind === kind));
      draw();
    };
    const draw = () => {
      const messages = (app.v.message_list ?? []).filter((/** @type {any} */ one) => !only || one.kind === only);
      fill(list, [...messages].reverse().map((/** @type {any} */ one) =>
        h("div", { class: `message ${one.kind}`, role: "listitem" }, h("span", { class: "mono muted" }, clock(one.time)), h("span", { class: "chip" }, KINDS[one.kind]?.() ?? one.kind), h("span", { class: "grow" }, one.text)),
      ));
      if (!messages.length) fill(list, h("p", { class: "muted", role: "listitem" }, _("No messages.")));
    };
    const older = async () => {
      const first = app.v.message_list?.find((/** @type {any} */ one) => one.id)?.id; // the page's own have none
      const found = await app.call("messages.read", { ...(first ? { before: first } : {}), count: 100 }).catch(() => []);
      const messages = found.messages ?? found;
      if (!messages.length) app.notify("notice", _("There are no older messages."));
      app.store.merge({ message_list: [...messages, ...(app.v.message_list ?? [])] });
    };
    fill(
      root,
      h(
        "div",
        { class: "card stack grow" },
        h("div", { class: "row" }, h("div", { class: "segments grow", role: "group", "aria-label": _("Kind of message") }, filters), iconButton("reload", _("Older"), older), iconButton("close", _("Close notices"), () => fill(/** @type {HTMLElement} */ (document.getElementById("toasts"))))),
        list,
      ),
    );
    app.store.watch(["message_list"], () => {
      draw();
      if (app.panels?.isVisible("messages")) app.store.merge({ unread: 0 });
    });
    return { show: () => app.store.merge({ unread: 0 }) };
  },
});
