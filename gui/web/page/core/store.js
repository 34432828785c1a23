/**
 * The machine's state as the page knows it: named values that arrive as deltas, and watchers that are called once per
 * picture for the names that they read.
 */

/** @typedef {Record<string, any>} Values */

export class Store {
  /** @type {Values} the newest value of each name */
  values = {};
  /** @type {Map<string, Set<Watcher>>} */
  #watchers = new Map();
  /** @type {Set<Watcher>} watchers to be called with the next picture */
  #waiting = new Set();
  #scheduled = false;

  /** Take new values; whoever watches one of them is called before the next picture. @param {Values} delta */
  merge(delta) {
    for (const [name, value] of Object.entries(delta)) {
      this.values[name] = value;
      for (const watcher of this.#watchers.get(name) ?? []) this.#waiting.add(watcher);
    }
    this.#schedule();
  }

  /**
   * Call a function now and whenever one of these names has a new value.
   * @param {string[]} names @param {(values: Values) => void} call
   * @returns {() => void} ends the watch
   */
  watch(names, call) {
    const watcher = new Watcher(call);
    for (const name of names) {
      if (!this.#watchers.has(name)) this.#watchers.set(name, new Set());
      this.#watchers.get(name)?.add(watcher);
    }
    this.#waiting.add(watcher);
    this.#schedule();
    return () => {
      for (const name of names) this.#watchers.get(name)?.delete(watcher);
      this.#waiting.delete(watcher);
    };
  }

  #schedule() {
    if (this.#scheduled || this.#waiting.size === 0) return;
    this.#scheduled = true;
    requestAnimationFrame(() => this.#flush());
  }

  #flush() {
    this.#scheduled = false;
    const due = [...this.#waiting];
    this.#waiting.clear();
    for (const watcher of due) {
      try {
        watcher.call(this.values);
      } catch (error) {
        console.error(error); // one panel's mistake must not stop the others
      }
    }
  }
}

class Watcher {
  /** @param {(values: Values) => void} call */
  constructor(call) {
    this.call = call;
  }
}
