/**
 * Texts in the operator's language. The English text is the key; the catalogues are `gui/web/locale/LANG.po`, which the
 * server hands out as JSON. A text with a number has two entries, one for the singular and one for the plural.
 */

/** @type {Record<string, string>} */
let catalogue = {};

export let language = "en";

/**
 * Load the catalogue of a language; English needs none.
 * @param {string} wanted such as `de` or `de-AT`
 */
export async function loadLanguage(wanted) {
  language = wanted.toLowerCase().split("-")[0];
  catalogue = {};
  if (language !== "en") {
    const answer = await fetch(`/catalogue/${encodeURIComponent(language)}.json`);
    if (answer.ok) catalogue = await answer.json();
    else language = "en";
  }
  document.documentElement.lang = language;
}

/** A text that the server sends and that its catalogue has, such as a question of the wizard. @param {string} text */
export function fromServer(text) {
  return catalogue[text] || text;
}

/**
 * The text in the operator's language, with `{name}` replaced from the values.
 * @param {string} text @param {Record<string, string | number>} [values]
 */
export function _(text, values) {
  const translated = catalogue[text] || text;
  return values ? translated.replace(/\{(\w+)\}/g, (whole, name) => String(values[name] ?? whole)) : translated;
}
