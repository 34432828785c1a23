/** The pocket calculator of number fields: + - * / ( ), and `in` or `mm` behind a number. */

const MM_PER_INCH = 25.4;
const TOKEN = /\s*(?:(\d+(?:[.,]\d*)?|[.,]\d+)\s*(in|mm|")?|([-+*/()]))/y;

/**
 * The value of an expression, in the unit that is asked for.
 * @param {string} text such as `10 + 25.4/2` or `1in` @param {"mm" | "inch"} unit
 * @returns {number} NaN if it is not an expression
 */
export function evaluate(text, unit) {
  const tokens = tokenize(text.trim(), unit);
  if (!tokens) return NaN;
  let at = 0;
  /** @returns {number} */
  const atom = () => {
    const token = tokens[at++];
    if (typeof token === "number") return token;
    if (token === "-") return -atom();
    if (token === "+") return atom();
    if (token !== "(") return NaN;
    const inner = sum();
    return tokens[at++] === ")" ? inner : NaN;
  };
  const product = () => {
    let value = atom();
    while (tokens[at] === "*" || tokens[at] === "/") value = tokens[at++] === "*" ? value * atom() : value / atom();
    return value;
  };
  const sum = () => {
    let value = product();
    while (tokens[at] === "+" || tokens[at] === "-") value = tokens[at++] === "+" ? value + product() : value - product();
    return value;
  };
  const value = sum();
  return at === tokens.length ? value : NaN;
}

/** @param {string} text @param {"mm" | "inch"} unit @returns {(number | string)[] | null} */
function tokenize(text, unit) {
  const tokens = [];
  TOKEN.lastIndex = 0;
  while (TOKEN.lastIndex < text.length) {
    const match = TOKEN.exec(text);
    if (!match) return null;
    tokens.push(match[1] === undefined ? match[3] : Number(match[1].replace(",", ".")) * factor(match[2], unit));
  }
  return tokens.length ? tokens : null;
}

/** @param {string | undefined} suffix @param {"mm" | "inch"} unit */
function factor(suffix, unit) {
  if (suffix === undefined) return 1;
  const inch = suffix !== "mm";
  return inch === (unit === "inch") ? 1 : inch ? MM_PER_INCH : 1 / MM_PER_INCH;
}
