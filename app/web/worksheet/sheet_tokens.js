// Parse the text of a worksheet: the parts of a line for its colours, and completions at the caret.
export const STATEMENTS = {
  given: "an input: given F [kN] \"radial load\"",
  choice: "an input in words: choice law = walther \"viscosity law\" (walther | vogel)",
  curve: "a table: curve mu(T [degC]) [mPa*s] \"viscosity\":",
  solve: "an unknown: solve x [mm] from 1 mm to 2 m so that … \"width\"",
  require: "what must hold, else the input is refused",
  check: "what should hold, else a warning",
  test: "a known result: test \"by hand\" with F = 25 kN gives p = 21.7 MPa within 0.2 %",
  plot: "one value over another: plot p over F",
};
const INSIDE = ["if", "not"];
const BETWEEN = ["then", "else", "and", "or", "is", "to", "so that", "from", "with", "gives", "within", "over"];
const CLAUSES = ["source", "symbol", "remedy", "also", "example", "published", "held"];
const FUNCTIONS = ["sqrt", "exp", "log", "log10", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "abs", "floor", "ceil", "min", "max", "sum", "mean", "count"];
const WORDS = new Set([...Object.keys(STATEMENTS), ...INSIDE, ...BETWEEN, "so", "that"]);
const UNITS = (
  "mm cm m um in ft mil N kN MN lbf Pa kPa MPa GPa bar psi N*m kN*m J kJ W kW hp kg g t kg/m**3 s min h rpm rad/s rev/s turn deg rad " +
  "Hz m/s mm/s m/s**2 mm**2 m**2 mm**3 m**3 mm**4 K degC degF delta_degC delta_degF 1/K Pa*s mPa*s mm**2/s cSt l/min W/(m*K) J/(kg*K) A V % 1"
).split(" ");
const NUMBER = String.raw`(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?`;
const UNIT = String.raw`(?:1\/)?[\p{L}°%](?:\*\*-?\d+|\^-?\d+|\/\([^()\s]*\)|[*/·](?=[\p{L}°%])|[\p{L}\p{N}_°%²³])*`;
const TOKEN = new RegExp(
  String.raw`("[^"]*"?)|((?<=\s)\[[^\][]*\]?)|(${NUMBER})(?: (?!(?:${[...WORDS].join("|")})\b)(${UNIT}))?|([\p{L}_][\p{L}\p{N}_.]*)|([-+*/^<>=!]+)|(\s+)|(.)`,
  "gu",
);
const KINDS = ["", "words", "unit", "number", "", "name", "sign"];

// Return the parts of a line, each with its kind; joined they are the line.
export function tokens(line) {
  const whole = { "#": "heading", ">": "prose" }[line[0]] ?? (line.startsWith("//") ? "remark" : null);
  if (whole) return [{ kind: whole, text: line }];
  return [...line.matchAll(TOKEN)].flatMap((match) => {
    const place = match.slice(1).findIndex((part) => part !== undefined) + 1, kind = KINDS[place] ?? "";
    if (kind === "number" && match[4]) return [{ kind, text: `${match[3]} ` }, { kind: "unit", text: match[4] }];
    return [{ kind: kind === "name" && WORDS.has(match[0]) ? "keyword" : kind, text: match[0] }];
  });
}

const WORD = /[\p{L}\p{N}_.]/u;

// Return where the text typed before the caret begins, and its possible kinds; null where nothing is completed.
export function wordAt(text, caret) {
  const line = text.slice(text.lastIndexOf("\n", caret - 1) + 1, caret);
  if (/^(#|>|\/\/)/.test(line) || (line.split('"').length - 1) % 2) return null;
  let length = 0;
  while (length < line.length && WORD.test(line.at(-1 - length))) length += 1;
  const before = line.slice(0, line.length - length), typed = line.slice(line.length - length);
  if (!/^[\p{L}_]/u.test(typed)) return null;
  const kind = kindAfter(before, text.slice(0, caret - line.length));
  return kind && { kind, typed, start: caret - length };
}

function kindAfter(before, above) {
  if (before === "") return "statement";
  if (/(^|\s)\[[^\]]*$/.test(before) || new RegExp(String.raw`(^|[^\p{L}\p{N}_.])${NUMBER} $`, "u").test(before)) return "unit";
  if (/"[^"]*"\s*\([^)]*(^|[(;]\s*)$/.test(before)) return "clause";
  const isExpression = /^\s/.test(before) ? above !== "" : /=|^(require|check|solve|test|plot)\b/.test(before);
  if (!isExpression) return null;
  return /[\p{L}\p{N}_.)\]"%]\s+$/u.test(before) && !/(^|\s)(if|then|else|and|or|not|is|require|check|solve|plot|over|from|to|that|with|gives|within)\s+$/.test(before) ? "between" : "name";
}

const worded = (names, words) => names.map((name) => ({ name, unit: "", words }));
const OF_KIND = {
  statement: Object.entries(STATEMENTS).map(([name, words]) => ({ name, unit: "", words })),
  unit: worded(UNITS, ""),
  clause: worded(CLAUSES, "clause"),
  between: worded(BETWEEN, "keyword"),
  name: [...worded(INSIDE, "keyword"), ...worded(FUNCTIONS, "function"), ...worded(["pi"], "3.14159…")],
};

// Return completions of the typed text: first those that begin with it, then those whose name or words contain it.
export function completions({ kind, typed }, names) {
  const all = kind === "name" ? [...names, ...OF_KIND.name.filter(({ name }) => !names.some((own) => own.name === name))] : OF_KIND[kind];
  const wanted = typed.toLowerCase(), begins = [], holds = [];
  for (const item of all) {
    const name = item.name.toLowerCase();
    if (name.startsWith(wanted)) begins.push(item);
    else if (kind === "name" && (name.includes(wanted) || (wanted.length > 1 && item.words.toLowerCase().includes(wanted)))) holds.push(item);
  }
  const isWhole = kind !== "unit" && all.some(({ name }) => name === typed); // Enter then begins the next line
  return isWhole ? [] : [...begins, ...holds];
}
