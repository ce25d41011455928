// Criteria in words, as app/presentation/criteria.py writes them.
import { percent, plain, quantityText, unit } from "../shared/numbers.js";

export const WORDS = { met: "met", not_met: "not met", undecided: "undecided", not_checked: "not checked" };
const UNKNOWN = "error unknown";
const ALMOST_ALL = 0.985;

// Value, sign and limit of a requirement, as written.
export function sides(require) {
  const parts = require.match(/^(.*?)\s*(>=|<=)\s*(.*)$/s);
  return parts ? parts.slice(1) : [require, "", ""];
}

export const plainName = (text) =>
  text.replace(/(?:[A-Za-z]\w*\.)*([A-Za-z]\w*)/g, (_, name) => name.replaceAll("_", " ")).trim();

export function stepOf({ name, require }) {
  if (name.includes(".")) return name.split(".")[0];
  const [block, ...rest] = sides(require)[0].trim().split(".");
  return rest.length && /^[A-Za-z_]\w*$/.test(block) ? block : "";
}

const isName = (text) => /^\s*(?:[A-Za-z]\w*\.)*[A-Za-z]\w*\s*$/.test(text);

// What is judged, and the criterion's own name where that does not hold it; another one may judge the same.
export function title({ name, require }) {
  const [left] = sides(require), own = plainName(name), subject = isName(left) ? plainName(left) : own;
  return subject.includes(own) ? subject : `${subject} (${own})`;
}

const isErrorUnknown = ({ verdict, error_known: isKnown = true }) => ["met", "not_met"].includes(verdict) && !isKnown;

export const verdictWords = (criterion) => `${WORDS[criterion.verdict]}${isErrorUnknown(criterion) ? `; ${UNKNOWN}` : ""}`;
export const tagOf = (criterion) => `${criterion.verdict}${isErrorUnknown(criterion) ? " error-unknown" : ""}`;
export const isOpen = (criterion) => criterion.verdict === "undecided" || (isErrorUnknown(criterion) && Boolean(criterion.level));

export function compared({ value, limit, require }) {
  if (!value || !limit) return "";
  const [, sign, right] = sides(require);
  const called = isName(right) ? `${plainName(right)} ` : "";
  const atLeast = sign === ">=" ? (value.value >= limit.value ? "≥" : "<") : value.value <= limit.value ? "≤" : ">";
  const [one, other] = toldApart(value, limit);
  return `${one} ${atLeast} ${called}${other}`;
}

// Two quantities in so many digits that they differ, unless they are equal.
function toldApart(value, limit) {
  const texts = [quantityText(value), quantityText(limit)];
  for (let digits = 4; texts[0] === texts[1] && value.value !== limit.value && digits <= 17; digits += 1)
    [value, limit].forEach((one, place) => (texts[place] = `${Number(one.value.toPrecision(digits))} ${unit(one.unit)}`.trim()));
  return texts;
}

export function margin({ margin: left, band, limit, require }) {
  if (!left) return "";
  const text = quantityText(left);
  if (!band || !limit || band.unit !== limit.unit || limit.unit !== left.unit) return text;
  const [low, high] = band.value, edge = limit.value;
  if (low === null || high === null || low === high) return text;
  const [least, most] = sides(require)[1] === ">=" ? [low - edge, high - edge] : [edge - high, edge - low];
  return `${text} (${plain(least)} … ${plain(most)})`;
}

export function error({ value, error_known: isKnown = true, relative_error: relative }) {
  if (!value) return "";
  if (!isKnown) return "unknown";
  return typeof relative === "number" ? `± ${percent(relative)}` : "open";
}

export function missing({ give, verdict, needs, reason }) {
  if (give?.length) return `give ${give.map(plainName).join(", ")}`;
  if (verdict === "undecided" && typeof needs === "number") return `needs an error below ${percent(needs)}`;
  return reason ?? "";
}

export function remarks(criterion) {
  const { unverified, waived, truth, reason } = criterion;
  return [
    unverified && `unverified: ${unverified}`,
    waived && `waived: ${waived}`,
    truth?.includes(" ") && truth,
    where(criterion),
    reason && missing(criterion) !== reason && reason,
  ].filter(Boolean);
}

function where({ where: places = {}, points, counts = {} }) {
  const named = Object.entries(places).map(([name, at]) => `${plainName(name)} ${quantityText(at)}`);
  const at = named.length ? `worst at ${named.join(", ")}` : "";
  if (!points || points === 1) return at;
  const numbers = Object.entries(counts).filter(([, number]) => number).map(([verdict, number]) => `${number} ${WORDS[verdict]}`);
  return [at, `${points} points: ${numbers.join(", ")}`].filter(Boolean).join("; ");
}

// About 100 % and above in four digits, to show on which side.
export function share(used) {
  if (typeof used !== "number") return "";
  return used < ALMOST_ALL ? percent(used) : `${plain(Number((used * 100).toPrecision(4)))} %`;
}
