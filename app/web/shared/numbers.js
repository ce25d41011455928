// Numbers and units as in app/presentation/numbers.py: five digits, aligned at the point, the unit once.
const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
const WORDS = { deg: "°", degC: "°C", degF: "°F", delta_degC: "K", delta_degF: "Δ°F", um: "µm", ohm: "Ω", thou: "mil", inch: "in", ureyn: "µreyn" };
const raised = (text) => [...text].map((sign) => RAISED[sign]).join("");

export function aligned(value) {
  const rounded = Number(value.toPrecision(5)), size = Math.abs(rounded);
  const plain = size === 0 || (size >= 1e-4 && size < 1e6);
  const [mantissa, exponent] = (plain ? String(rounded) : rounded.toExponential()).split("e");
  const [whole, fraction] = mantissa.split(".");
  const power = exponent ? `·10${raised(exponent.replace("+", ""))}` : "";
  return [whole.replace("-", "−"), (fraction ? `.${fraction}` : "") + power];
}

export const plain = (value) => aligned(value).join("");

export function unit(text) {
  if (!text || text === "1") return "";
  const powers = text.replace(/\*\*(-?[0-9]+)/g, (_, power) => raised(power));
  return powers.replace(/[A-Za-z_]+/g, (word) => WORDS[word] ?? word).replaceAll("*", "·");
}

export const percent = (relative) => `${plain(Number((relative * 100).toPrecision(2)))} %`;

export function quantityText(quantity) {
  if (quantity === null || quantity === undefined) return "";
  if (typeof quantity !== "object" || Array.isArray(quantity)) return written(quantity);
  if (!hasValue(quantity.value)) return quantity.reason ?? "none";
  return [written(quantity.value), unit(quantity.unit), remark(quantity.value)].filter(Boolean).join(" ");
}

// Return a rounded value: calculated 23.47 mm → chosen 23.5 mm.
export const roundedText = ({ calculated, chosen }) => `calculated ${quantityText(calculated)} → chosen ${quantityText(chosen)}`;

// A list in which every value is missing has none.
const hasValue = (value) => (Array.isArray(value) && value.length ? value.some(hasValue) : value !== null);

function written(value) {
  if (value === null) return "–";
  if (typeof value === "number") return plain(value);
  if (!Array.isArray(value)) return String(value);
  const flat = value.flat(Infinity);
  if (flat.length <= FEW) return `[${value.map(written).join(", ")}]`;
  return extremes(flat)?.map((place) => written(flat[place])).join(" … ") ?? "[…]";
}

// Describe a long list: the number of values, and the positions of the smallest and the largest.
function remark(values) {
  if (!Array.isArray(values) || values.flat(Infinity).length <= FEW) return "";
  const ends = values.some(Array.isArray) ? null : extremes(values);
  return `(${counted(values)} values${ends ? `; least no. ${ends[0] + 1}, largest no. ${ends[1] + 1}` : ""})`;
}

export const FEW = 20; // longest list that is shown completely

// Return the number of values: 720, or 3 × 24 for a table.
export const counted = (values) => (Array.isArray(values[0]) ? `${values.length} × ${counted(values[0])}` : String(values.length));

// Return the positions of the smallest and the largest number; null if there is none.
export function extremes(values) {
  let least = -1, largest = -1;
  values.forEach((value, place) => {
    if (typeof value !== "number") return;
    if (least < 0 || value < values[least]) least = place;
    if (largest < 0 || value > values[largest]) largest = place;
  });
  return least < 0 ? null : [least, largest];
}
