// The typeset sheet, line by line next to the text: formulas, their values, prose, verdicts, tests.
import { isolated } from "../shared/isolated.js";
import { plain, quantityText, unit } from "../shared/numbers.js";

function element(tag, className, ...inside) {
  const node = Object.assign(document.createElement(tag), { className });
  node.append(...inside);
  return node;
}

const EQUALS = "<mo>&#x0003D;</mo>"; // as the service writes it
const VERDICTS = { met: "met", not_met: "not met", true: "met", false: "not met" };

export class Typeset {
  constructor(list) {
    this.list = list;
    this.keys = [];
  }

  // Draw the service's answer; an unchanged line keeps its element.
  show({ lines, faults, tests }) {
    const rows = rowsOf(lines, faults, tests), places = this.list.children;
    const keys = rows.map((row) => JSON.stringify(row));
    for (const [place, row] of rows.entries()) {
      if (this.keys[place] === keys[place]) continue;
      const node = drawn(row);
      if (places[place]) places[place].replaceWith(node);
      else this.list.append(node);
    }
    while (places.length > rows.length) places[rows.length].remove();
    this.keys = keys;
  }

  // Place each line next to its text, or as near below as the lines above it allow; in a column, one below another.
  align(top, isBeside) {
    const rows = [...this.list.children];
    for (const row of rows) row.style.marginTop = "";
    if (!isBeside) return;
    const heights = rows.map((row) => row.offsetHeight);
    let end = 0;
    const gaps = rows.map((row, place) => {
      const gap = Math.max(0, top(Number(row.dataset.line)) - end);
      end += gap + heights[place];
      return gap;
    });
    for (const [place, row] of rows.entries()) row.style.marginTop = `${gaps[place]}px`;
  }
}

// Return the present positions of unchanged lines of the last sheet without faults.
export function stillThere(lines, old, texts) {
  let head = 0, tail = 0;
  const most = Math.min(old.length, texts.length), shift = texts.length - old.length;
  while (head < most && old[head] === texts[head]) head += 1;
  while (tail < most - head && old.at(-1 - tail) === texts.at(-1 - tail)) tail += 1;
  return lines.flatMap((line) => {
    if (line.last_line <= head) return [{ ...line, is_before: true }];
    return line.line > old.length - tail ? [{ ...line, line: line.line + shift, last_line: line.last_line + shift, is_before: true }] : [];
  });
}

// Draw one row for each statement, with its results, faults and test.
export function rowsOf(lines, faults, tests) {
  const byLine = new Map();
  for (const line of lines) byLine.set(line.line, { ...line, faults: [] });
  for (const fault of faults) {
    const row = lines.find(({ line, last_line: last }) => line <= fault.line && fault.line <= (last ?? line))?.line ?? fault.line;
    if (!byLine.has(row)) byLine.set(row, { line: row, kind: "faulty", faults: [] });
    byLine.get(row).faults.push(fault);
  }
  for (const test of tests) {
    if (!byLine.has(test.line)) byLine.set(test.line, { line: test.line, kind: "test", words: test.words, faults: [] });
    byLine.get(test.line).test = test;
  }
  return [...byLine.values()].sort((one, other) => one.line - other.line);
}

function drawn(row) {
  const node = element("li", `typeset-line ${row.kind}${row.is_before ? " before" : ""}`, ...(row.kind === "prose" ? [prose(row)] : statement(row)));
  node.dataset.line = row.line;
  node.append(...row.faults.map(faultOf));
  return node;
}

function prose(row) {
  const node = element("div", "prose");
  node.innerHTML = row.html; // the service escaped it
  return node;
}

function statement(row) {
  const parts = [], words = row.words && element("span", "line-words", isolated(row.words));
  if (row.mathml) {
    const math = element("span", "line-math");
    math.innerHTML = row.mathml; // MathML that the service escaped
    parts.push(math);
  } else if (row.kind !== "test" && row.name) parts.push(element("code", "", row.name));
  const value = saysItsValue(row) ? "" : valueOf(row);
  if (value) parts.push(element("span", "line-value", `= ${value}`));
  if (row.verdict !== null && row.verdict !== undefined) parts.unshift(verdictTag(VERDICTS[row.verdict] ?? String(row.verdict)));
  if (row.test) parts.unshift(element("span", `tag ${row.test.passed ? "met" : "not_met"}`, row.test.passed ? "passed" : "failed"));
  if (words) parts.push(words);
  const message = row.test && !row.test.passed ? row.test.message : row.message;
  if (message) parts.push(element("span", "line-message", isolated(message)));
  return parts;
}

// Return whether a statement itself shows its value, as the default in `T = 20 °C`.
const saysItsValue = ({ kind, mathml }) => kind === "given" && mathml.includes(EQUALS) && !mathml.split(EQUALS)[1].includes("<mi>");

const verdictTag = (words) => element("span", `tag ${words.replace(" ", "_")}`, words);

export function valueOf({ value, unit: symbol, text }) {
  if (text) return text;
  if (value === null || value === undefined) return "";
  if (Array.isArray(value)) return quantityText({ value, unit: symbol });
  return [typeof value === "number" ? plain(value) : String(value), unit(symbol)].filter(Boolean).join(" ");
}

function faultOf(fault) {
  const node = element("p", "field-error", element("b", "", `Line ${fault.line}, column ${fault.column}: `), isolated(fault.message));
  if (fault.remedy) node.append(": ", element("span", "remedy", isolated(fault.remedy)));
  return node;
}
