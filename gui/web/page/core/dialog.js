/** Modal dialogs: a title, content, and buttons; the browser's own <dialog> keeps the focus and closes on Escape. */

import { h, uniqueId } from "./dom.js";
import { _ } from "./i18n.js";

/**
 * @typedef {object} Action
 * @property {string} text
 * @property {string} [kind] class of the button: `primary`, `danger`, `go`
 * @property {(close: () => void) => unknown} [act] closes by itself if absent; a promise that rejects keeps it open
 * @property {boolean} [submit] Enter presses it
 */

/**
 * @param {string} title @param {import("./dom.js").Child[]} content @param {Action[]} actions
 * @param {{wide?: boolean, onclose?: () => void, fixed?: boolean}} [options] `fixed`: Escape does not close it
 * @returns {{element: HTMLDialogElement, close: () => void}}
 */
export function openDialog(title, content, actions, { wide = false, onclose, fixed = false } = {}) {
  const id = uniqueId("dialog");
  const close = () => element.close();
  const run = (/** @type {Action} */ action) => (action.act ? action.act(close) : close());
  const buttons = actions.map((action) =>
    h("button", { type: action.submit ? "submit" : "button", class: action.kind ?? "", onclick: action.submit ? null : () => run(action) }, action.text),
  );
  const submit = actions.find((action) => action.submit);
  const element = /** @type {HTMLDialogElement} */ (
    h(
      "dialog",
      { "aria-labelledby": id, class: wide ? "wide" : "" },
      h(
        "form",
        {
          method: "dialog",
          novalidate: true,
          onsubmit: (/** @type {Event} */ event) => {
            event.preventDefault();
            if (submit) run(submit);
          },
        },
        h("h2", { id }, title),
        h("div", { class: "content" }, ...content),
        h("div", { class: "actions" }, buttons),
      ),
    )
  );
  element.addEventListener("cancel", (event) => fixed && event.preventDefault());
  element.addEventListener("close", () => {
    element.remove();
    onclose?.();
  });
  document.body.append(element);
  element.showModal();
  return { element, close };
}

/**
 * Ask yes or no.
 * @param {string} title @param {string} text @param {string} yes label of the button that does it
 * @param {string} [kind] its class @returns {Promise<boolean>}
 */
export function confirm(title, text, yes, kind = "primary") {
  return new Promise((resolve) => {
    let answer = false;
    openDialog(
      title,
      [h("p", null, text)],
      [
        { text: _("Cancel") },
        {
          text: yes,
          kind,
          submit: true,
          act: (close) => {
            answer = true;
            close();
          },
        },
      ],
      { onclose: () => resolve(answer) },
    );
  });
}

/**
 * Ask for a line of text.
 * @param {string} title @param {string} label @param {string} [value] @returns {Promise<string | null>}
 */
export function ask(title, label, value = "") {
  return new Promise((resolve) => {
    /** @type {string | null} */
    let answer = null;
    const input = h("input", { type: "text", value, "aria-label": label, autofocus: true });
    openDialog(
      title,
      [h("label", { class: "stack" }, label, input)],
      [
        { text: _("Cancel") },
        {
          text: _("OK"),
          kind: "primary",
          submit: true,
          act: (close) => {
            answer = input.value.trim();
            if (answer) close();
          },
        },
      ],
      { onclose: () => resolve(answer) },
    );
  });
}
