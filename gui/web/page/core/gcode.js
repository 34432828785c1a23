/** Colours for G-code text: comments, words of motion and function, numbers. */

import { h } from "./dom.js";

const PARTS = /(\([^)]*\)?|;.*)|\b(?:GT|LT|GE|LE|EQ|NE|AND|OR|XOR|MOD)\b|([GM]\s*\d+(?:\.\d+)?)|([FSTHDN]\s*[-+\d.#[][^\sA-Z(;]*)|(#<[^>]*>|#\d+)|(\bo\s*(?:<[^>]*>|\d+)\s*\w*)/gi;
const CLASSES = ["", "comment", "code", "word", "parameter", "flow"];

/** The nodes of one line. @param {string} line @returns {(Node | string)[]} */
export function highlight(line) {
  const nodes = [];
  let end = 0;
  for (const match of line.matchAll(PARTS)) {
    if (match.index > end) nodes.push(line.slice(end, match.index));
    const kind = CLASSES[match.findIndex((part, n) => n > 0 && part !== undefined)];
    nodes.push(kind ? h("span", { class: `gcode-${kind}` }, match[0]) : match[0]); // operators stay plain
    end = match.index + match[0].length;
  }
  nodes.push(line.slice(end));
  return nodes;
}
