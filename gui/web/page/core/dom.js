/**
 * Make and change elements without a framework and without markup in strings, so that no text from the
 * machine can become HTML.
 */

/**
 * @typedef {Node | string | number | null | undefined | false} Child
 * @typedef {Record<string, any>} Properties `class`, `style` (object), `data` (object), `on*` functions, attributes
 */

/**
 * @param {string} tag element name; `svg:NAME` makes an SVG element
 * @param {Properties | null} [properties]
 * @param {...(Child | Child[])} children
 * @returns {any} the element
 */
export function h(tag, properties, ...children) {
  const element = tag.startsWith("svg:")
    ? document.createElementNS("http://www.w3.org/2000/svg", tag.slice(4))
    : document.createElement(tag);
  for (const [name, value] of Object.entries(properties ?? {})) setProperty(element, name, value);
  element.append(.../** @type {any} */ (children.flat().filter((child) => child !== null && child !== undefined && child !== false)));
  return element;
}

/** @param {any} element @param {string} name @param {any} value */
function setProperty(element, name, value) {
  if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
  else if (name === "data") Object.assign(element.dataset, value);
  else if (name === "style") Object.assign(element.style, value);
  else if (name === "value" || name === "checked" || name === "indeterminate") element[name] = value;
  else if (value === true) element.setAttribute(name, "");
  else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, String(value));
}

/**
 * Replace an element's children.
 * @param {Element} element @param {...(Child | Child[])} children
 */
export function fill(element, ...children) {
  element.replaceChildren(.../** @type {any} */ (children.flat().filter((child) => child !== null && child !== undefined && child !== false)));
}

/** Write a text only when it differs, which spares the browser layout work. @param {Node} node @param {string} text */
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** Set or clear an attribute without a value. @param {Element} element @param {string} name @param {boolean} on */
export function setFlag(element, name, on) {
  if (element.hasAttribute(name) !== on) element.toggleAttribute(name, on);
}

/** @param {Element} element @param {string} name @param {string} value */
export function setAttribute(element, name, value) {
  if (element.getAttribute(name) !== value) element.setAttribute(name, value);
}

/** Show whether a two-state button is on. @param {Element} button @param {boolean} on */
export function setPressed(button, on) {
  setAttribute(button, "aria-pressed", String(on));
}

let serial = 0;

/** An id that no other element has. @param {string} stem */
export function uniqueId(stem) {
  serial += 1;
  return `${stem}-${serial}`;
}

/**
 * A labelled input.
 * @param {string} label @param {HTMLElement} input @param {string} [unit]
 * @returns {HTMLElement}
 */
export function field(label, input, unit = "") {
  if (!input.id) input.id = uniqueId("field");
  return h("div", { class: "field" }, h("label", { for: input.id }, label), input, unit && h("span", { class: "unit" }, unit));
}

/**
 * A drop-down list.
 * @param {[string | number, string][]} choices value and text
 * @param {string | number} chosen @param {(value: string) => void} changed @param {Properties} [properties]
 * @returns {HTMLSelectElement}
 */
export function select(choices, chosen, changed, properties = {}) {
  const element = h(
    "select",
    { ...properties, onchange: () => changed(element.value) },
    choices.map(([value, text]) => h("option", { value, selected: String(value) === String(chosen) }, text)),
  );
  return element;
}

/**
 * Rows for a table's body.
 * @param {Child[][]} rows @returns {HTMLElement[]}
 */
export function tableRows(rows) {
  return rows.map((cells) => h("tr", null, cells.map((cell) => h("td", null, cell))));
}
