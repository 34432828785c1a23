/**
 * What every panel is given: the store, calls whose failures the operator sees, gates that enable and disable controls,
 * notices. One object of this class exists; panels get it as `app`.
 */

import { h, setAttribute } from "./dom.js";
import { icon, iconButton } from "./icons.js";
import { CallError } from "./link.js";
import { _ } from "./i18n.js";
import { GATE_KEYS } from "./machine.js";

/** @typedef {import("./store.js").Values} Values */
/** @typedef {import("./store.js").Store} Store */
/** @typedef {import("./link.js").Link} Link */

const TOAST_MS = { notice: 5000, text: 8000, display: 12000 }; // errors stay until they are closed
const TOASTS = 4;

export class App {
  /** @type {{element: any, why: (v: Values) => string}[]} */
  #gates = [];

  /** @param {Store} store @param {Link} link */
  constructor(store, link) {
    this.store = store;
    this.link = link;
    /** @type {import("./panels.js").Panels} set by main.js */
    this.panels = /** @type {any} */ (null);
    /** @type {import("./jog.js").Jogger} set by main.js */
    this.jogger = /** @type {any} */ (null);
    store.watch(GATE_KEYS, (v) => this.#openGates(v));
  }

  /** The values of the store. @returns {Values} */
  get v() {
    return this.store.values;
  }

  /**
   * Call a method; an error is shown to the operator and then thrown.
   * @param {string} method @param {Record<string, any>} [args] @returns {Promise<any>}
   */
  async call(method, args) {
    try {
      return await this.link.call(method, args);
    } catch (error) {
      this.showError(error);
      throw error;
    }
  }

  /**
   * A call whose value nobody needs; its error has been shown when this returns.
   * @param {string} method @param {Record<string, any>} [args] @returns {Promise<boolean>} whether it was done
   */
  async act(method, args) {
    try {
      await this.call(method, args);
      return true;
    } catch {
      return false;
    }
  }

  /** @param {any} error */
  showError(error) {
    // What the machine said arrives as a message too; do not say it twice.
    if (error instanceof CallError && error.code === "machine" && error.details.messages?.length) return;
    if (error instanceof CallError && error.code === "aborted") return; // the operator's own doing
    const text = error.message || String(error);
    this.notify("error", text);
    this.store.merge({ message_list: [...(this.v.message_list ?? []), { id: 0, kind: "error", text, time: Date.now() / 1000 }] });
  }

  /**
   * Show a notice above the panels.
   * @param {"error" | "text" | "display" | "notice"} kind @param {string} text
   */
  notify(kind, text) {
    const place = /** @type {HTMLElement} */ (document.getElementById("toasts"));
    const same = [...place.children].find((child) => /** @type {HTMLElement} */ (child).dataset.text === text);
    same?.remove();
    const toast = h(
      "div",
      { class: `notice ${kind === "error" ? "danger" : ""}`, data: { text, kind } },
      h("p", null, text),
      iconButton("close", _("Close"), () => toast.remove(), { iconOnly: true, class: "plain" }),
    );
    place.append(toast);
    while (place.children.length > TOASTS) place.firstElementChild?.remove();
    const life = /** @type {any} */ (TOAST_MS)[kind];
    if (life) setTimeout(() => toast.remove(), life);
  }

  /**
   * Enable a control only while a condition holds; the reason why not becomes its tooltip.
   * @template {Element} T
   * @param {T} element button, input or fieldset
   * @param {(v: Values) => string} why an empty text: enabled
   * @returns {T}
   */
  gate(element, why) {
    this.#gates.push({ element, why });
    this.#apply(element, why(this.v));
    return element;
  }

  /**
   * A button behind a gate.
   * @param {string} pictogram empty: none @param {string} text @param {() => unknown} act
   * @param {(v: Values) => string} why @param {Record<string, any>} [properties]
   * @returns {HTMLButtonElement}
   */
  button(pictogram, text, act, why, properties = {}) {
    const { iconOnly, ...rest } = properties;
    const label = iconOnly ? { "aria-label": text } : {};
    return this.gate(
      h("button", { type: "button", onclick: act, ...label, ...rest }, pictogram && icon(pictogram), iconOnly ? null : h("span", null, text)),
      why,
    );
  }

  /** @param {Values} v */
  #openGates(v) {
    for (const { element, why } of this.#gates) this.#apply(element, why(v));
  }

  /** @param {any} element @param {string} reason */
  #apply(element, reason) {
    if (element.disabled !== Boolean(reason)) element.disabled = Boolean(reason);
    setAttribute(element, "title", reason || element.getAttribute("aria-label") || "");
  }

  /** Forget the gates of elements that a panel has thrown away. @param {Element} root */
  release(root) {
    this.#gates = this.#gates.filter(({ element }) => !root.contains(element));
  }
}
