/** The access token: it comes once in the address (`#token=…`), stays in this browser, and never in the address bar. */

import { recall, remember } from "./prefs.js";

const IN_ADDRESS = /^#token=(.+)$/;

/** @returns {string | null} */
export function token() {
  const match = IN_ADDRESS.exec(location.hash);
  if (match) {
    remember("token", decodeURIComponent(match[1]));
    history.replaceState(null, "", location.pathname);
  }
  return recall("token", null);
}

/** @param {string} value */
export function setToken(value) {
  remember("token", value);
}
