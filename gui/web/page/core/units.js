/**
 * Lengths on the screen. The machine speaks machine units (`config.units`); the operator chose mm, inch, or the units
 * that the program uses at the moment (G20, G21).
 */

import { recall, remember } from "./prefs.js";

/** @typedef {import("./store.js").Values} Values */

const MM_PER = { mm: 1, inch: 25.4 };
const DIGITS = { mm: 3, inch: 4 };
const ANGLE_DIGITS = 3;
const PROGRAM_UNITS = { 1: "inch", 2: "mm", 3: "mm" };

/** @returns {"auto" | "mm" | "inch"} */
export function unitChoice() {
  return recall("units", /** @type {"auto" | "mm" | "inch"} */ ("auto"));
}

/** @param {string} choice */
export function chooseUnits(choice) {
  remember("units", choice);
}

/** The unit that lengths are shown in now. @param {Values} v @returns {"mm" | "inch"} */
export function displayUnit(v) {
  const choice = unitChoice();
  if (choice !== "auto") return choice;
  const machine = v.config?.units?.linear === "inch" ? "inch" : "mm";
  return /** @type {any} */ (PROGRAM_UNITS)[v.program_units] ?? machine;
}

/** Shown units for one machine unit. @param {Values} v */
export function scale(v) {
  return (v.config?.units?.mm_per_unit ?? 1) / MM_PER[displayUnit(v)];
}

/** @param {number} value machine units @param {Values} v */
export function length(value, v) {
  return fixed(value * scale(v), DIGITS[displayUnit(v)]);
}

/** @param {number} degrees */
export function angle(degrees) {
  return fixed(degrees, ANGLE_DIGITS);
}

/** A number without a minus sign before zeros. @param {number} value @param {number} digits */
export function fixed(value, digits) {
  if (!Number.isFinite(value)) return "–";
  const text = value.toFixed(digits);
  return Number(text) === 0 ? text.replace("-", "") : text;
}

/** A coordinate of axis number 0 to 8 (X..W). @param {number} axis @param {number} value @param {Values} v */
export function coordinate(axis, value, v) {
  return axis >= 3 && axis <= 5 ? angle(value) : length(value, v);
}

/** `1:02:03` or `2:03`. @param {number} seconds */
export function duration(seconds) {
  const whole = Math.max(0, Math.round(seconds));
  const parts = [Math.floor(whole / 3600), Math.floor((whole % 3600) / 60), whole % 60];
  if (parts[0] === 0) parts.shift();
  return parts.map((part, n) => (n === 0 ? String(part) : String(part).padStart(2, "0"))).join(":");
}

/** @param {number} bytes */
export function fileSize(bytes) {
  if (bytes < 1000) return `${bytes} B`;
  return bytes < 1e6 ? `${(bytes / 1e3).toFixed(1)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}

/** Time of day of a Unix time. @param {number} time */
export function clock(time) {
  return new Date(time * 1000).toLocaleTimeString(document.documentElement.lang);
}
