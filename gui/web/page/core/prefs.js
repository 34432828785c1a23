/**
 * What this browser remembers: theme, language, chosen increment and the like. Nothing of the machine depends on it. What
 * suits the machine rather than the screen is also kept by the server ([DISPLAY]PREFERENCE_FILE_PATH), where a browser that
 * has not been here before finds it.
 */

const PREFIX = "pyemc.";
const OF_THE_MACHINE = new Set(["units", "jog.linear", "jog.angular", "colouring", "meters", "scope"]);
const WRITE_PAUSE_MS = 1000; // a slider that is dragged is written once

/** @type {Record<string, any>} the server's */
let kept = {};
/** @type {Record<string, any>} on the way to the server */
let changed = {};
/** @type {(values: Record<string, any>) => void} */
let write = () => {};
/** @type {ReturnType<typeof setTimeout> | undefined} */
let timer;

/**
 * Take the server's preferences, and tell it of changes from now on.
 * @param {Record<string, any>} values @param {(values: Record<string, any>) => void} writer
 */
export function keepOnServer(values, writer) {
  kept = values;
  write = writer;
}

/** @template T @param {string} name @param {T} fallback @returns {T} */
export function recall(name, fallback) {
  try {
    const text = localStorage.getItem(PREFIX + name);
    return text === null ? (kept[name] ?? fallback) : JSON.parse(text);
  } catch {
    return fallback; // storage is off, or somebody else wrote there
  }
}

/** @param {string} name @param {unknown} value */
export function remember(name, value) {
  try {
    localStorage.setItem(PREFIX + name, JSON.stringify(value));
  } catch {
    // Private windows may refuse; the page works without memory.
  }
  if (!OF_THE_MACHINE.has(name)) return;
  changed[name] = value;
  clearTimeout(timer);
  timer = setTimeout(() => {
    write(changed);
    changed = {};
  }, WRITE_PAUSE_MS);
}
