/**
 * The loaded program's text. Only the lines in sight exist as elements, and only pages around them are fetched, so a
 * million lines cost no more than a hundred.
 */

import { fill, h, setAttribute, setFlag } from "../core/dom.js";
import { highlight } from "../core/gcode.js";
import { _ } from "../core/i18n.js";

const ROW = 28; // px
const PAGE = 400; // lines of one request
const PAGES_KEPT = 40;
const TALLEST = 6_000_000; // px; browsers clip taller elements, so beyond it scrolling is scaled
const HANDS_OFF_MS = 4000; // after the operator scrolled, the text does not follow the machine

/** @typedef {{element: HTMLElement, text: string | null | undefined, error: string | undefined}} Row `text` null: not written yet */

export class ProgramText {
  #total = 0;
  #version = /** @type {unknown} */ (null);
  /** @type {Map<number, string[]>} */
  #pages = new Map();
  /** @type {Set<number>} */
  #asked = new Set();
  /** @type {Map<number, string>} text of the error at a line */
  errors = new Map();
  #active = 0;
  #selected = 0;
  #touched = 0;
  #drawn = false;
  /** @type {Row[]} the elements of the lines in sight; they stay, so that a press that a redraw falls into still counts */
  #rows = [];
  #firstRow = 0;

  /**
   * @param {import("../core/app.js").App} app
   * @param {(line: number) => void} choose a line was pressed
   */
  constructor(app, choose) {
    this.app = app;
    this.choose = choose;
    this.rows = h("div", { class: "rows" });
    this.spacer = h("div", { class: "spacer" }, this.rows);
    this.element = h("div", { class: "program-text scroll", tabindex: 0, role: "listbox", "aria-label": _("Program text"), onscroll: () => this.#draw() }, this.spacer);
    this.element.addEventListener("wheel", (/** @type {WheelEvent} */ event) => this.#wheel(event), { passive: false });
    this.element.addEventListener("pointerdown", () => (this.#touched = performance.now()));
    this.element.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => this.#key(event));
    new ResizeObserver(() => this.#draw()).observe(this.element);
  }

  /** Lines that share one pixel of scrolling more than they are high. */
  get #squeeze() {
    return Math.max(1, (this.#total * ROW) / TALLEST);
  }

  /** Show another program, or none. @param {{lines: number, version: unknown} | null} program */
  load(program) {
    this.#total = program?.lines ?? 0;
    this.#version = program?.version ?? null;
    this.#pages.clear();
    this.#asked.clear();
    this.errors.clear();
    this.#active = 0;
    this.#selected = 0;
    this.spacer.style.height = `${Math.min(this.#total * ROW, TALLEST)}px`;
    this.element.scrollTop = 0;
    this.#draw();
  }

  /** Mark the line that the machine executes, and keep it in sight. @param {number} line 0: none */
  setActive(line) {
    if (line === this.#active) return;
    this.#active = line;
    if (line && performance.now() - this.#touched > HANDS_OFF_MS) this.reveal(line);
    this.#draw();
  }

  /** @param {number} line 0: none */
  select(line) {
    this.#selected = line;
    if (line) this.reveal(line);
    this.#draw();
  }

  /** Scroll as little as needed. @param {number} line */
  reveal(line) {
    const view = this.element.clientHeight / ROW;
    const first = this.#firstLine();
    if (line - 1 < first + 1 || line - 1 > first + view - 3) this.#scrollTo(line - 1 - view / 2);
  }

  redraw() {
    this.#draw();
  }

  #firstLine() {
    if (this.#squeeze === 1) return this.element.scrollTop / ROW;
    const span = Math.min(this.#total * ROW, TALLEST) - this.element.clientHeight;
    return span > 0 ? (this.element.scrollTop / span) * (this.#total - this.element.clientHeight / ROW) : 0;
  }

  /** @param {number} first */
  #scrollTo(first) {
    const view = this.element.clientHeight / ROW;
    const share = Math.min(Math.max(first / Math.max(this.#total - view, 1), 0), 1);
    const span = Math.min(this.#total * ROW, TALLEST) - this.element.clientHeight;
    this.element.scrollTop = this.#squeeze === 1 ? first * ROW : share * span;
  }

  /** A wheel click moves lines, not shares of a million of them. @param {WheelEvent} event */
  #wheel(event) {
    this.#touched = performance.now();
    if (this.#squeeze === 1) return;
    event.preventDefault();
    this.#scrollTo(this.#firstLine() + event.deltaY / ROW);
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    const line = Math.min(Math.max((this.#selected || this.#active) + step, 1), this.#total);
    this.choose(line);
  }

  #draw() {
    if (this.#drawn) return;
    this.#drawn = true;
    requestAnimationFrame(() => {
      this.#drawn = false;
      this.#drawNow();
    });
  }

  #drawNow() {
    const first = Math.max(Math.floor(this.#firstLine()), 0);
    const count = Math.max(Math.min(Math.ceil(this.element.clientHeight / ROW) + 2, this.#total - first), 0);
    if (first !== this.#firstRow || count !== this.#rows.length) {
      this.#firstRow = first;
      this.#rows = Array.from({ length: count }, (_none, n) => this.#row(first + n + 1));
      fill(this.rows, this.#rows.map(({ element }) => element));
    }
    this.rows.style.transform = `translateY(${this.#squeeze === 1 ? first * ROW : this.element.scrollTop}px)`;
    this.#rows.forEach((row, n) => this.#write(row, first + n + 1));
  }

  /** @param {number} line @returns {Row} */
  #row(line) {
    const element = h("div", { class: "line", role: "option", data: { line }, onclick: () => this.choose(line) });
    return { element, text: null, error: undefined };
  }

  /** Bring one line up to date. @param {Row} row @param {number} line */
  #write(row, line) {
    const { element } = row;
    const text = this.#line(line);
    const error = this.errors.get(line);
    if (text !== row.text || error !== row.error) {
      Object.assign(row, { text, error });
      fill(
        element,
        h("span", { class: "number" }, String(line)),
        h("span", { class: "text" }, text === undefined ? "…" : highlight(text)),
        error && h("span", { class: "error" }, error),
      );
      element.title = error ?? "";
    }
    setAttribute(element, "aria-selected", String(line === this.#selected));
    setFlag(element, "data-active", line === this.#active);
    setFlag(element, "data-error", error !== undefined);
  }

  /** @param {number} line @returns {string | undefined} */
  #line(line) {
    const page = Math.floor((line - 1) / PAGE);
    const lines = this.#pages.get(page);
    if (!lines) this.#fetch(page);
    return lines?.[(line - 1) % PAGE];
  }

  /** @param {number} page */
  async #fetch(page) {
    if (this.#asked.has(page)) return;
    this.#asked.add(page);
    const version = this.#version;
    try {
      const answer = await this.app.link.call("program.lines", { first: page * PAGE + 1, count: PAGE });
      if (version !== this.#version) return;
      this.#pages.set(page, answer.lines);
      if (this.#pages.size > PAGES_KEPT) this.#pages.delete(this.#pages.keys().next().value ?? -1);
      this.#draw();
    } catch {
      // Asked again when the line is drawn next; the link shows that it is down.
    } finally {
      this.#asked.delete(page);
    }
  }
}
