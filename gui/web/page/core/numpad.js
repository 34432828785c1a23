/** A number field with a calculator pad below it, for touch screens; the field takes expressions too. */

import { h, setText } from "./dom.js";
import { evaluate } from "./expression.js";
import { _ } from "./i18n.js";
import { icon } from "./icons.js";

const KEYS = ["7", "8", "9", "/", "4", "5", "6", "*", "1", "2", "3", "-", "0", ".", "⌫", "+"];

/**
 * @param {string} label @param {string} value first text @param {"mm" | "inch"} unit
 * @returns {{element: HTMLElement, input: HTMLInputElement, value: () => number}}
 */
export function numpad(label, value, unit) {
  const result = h("output", { class: "mono result" });
  const input = /** @type {HTMLInputElement} */ (
    h("input", { type: "text", inputmode: "none", class: "number big", "aria-label": label, value, autocomplete: "off", oninput: () => update() })
  );
  const current = () => evaluate(input.value, unit);
  function update() {
    const number = current();
    const valid = Number.isFinite(number);
    input.setAttribute("aria-invalid", String(!valid));
    setText(result, valid ? `= ${Math.round(number * 1e6) / 1e6}` : _("Not a number"));
  }
  /** @param {string} key */
  function press(key) {
    if (input.selectionStart !== input.selectionEnd) input.setRangeText("", input.selectionStart ?? 0, input.selectionEnd ?? 0, "end");
    const at = input.selectionStart ?? input.value.length;
    if (key === "⌫") input.setRangeText("", Math.max(at - 1, 0), at, "end");
    else input.setRangeText(key, at, at, "end");
    update();
  }
  const keys = KEYS.map((key) =>
    h("button", { type: "button", "aria-label": key === "⌫" ? _("Delete") : key, onclick: () => press(key), onpointerdown: (/** @type {Event} */ e) => e.preventDefault() }, key),
  );
  const clear = h("button", { type: "button", "aria-label": _("Clear"), onclick: () => { input.value = ""; update(); input.focus(); } }, icon("close"));
  const element = h("div", { class: "numpad" }, h("div", { class: "row" }, input, clear), result, h("div", { class: "keys" }, keys));
  update();
  queueMicrotask(() => input.select());
  return { element, input, value: current };
}
