// Numbers and units as app/web/numbers.py writes them: five digits, aligned at the point, the unit once.
const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
const WORDS = { deg: "°", degC: "°C", degF: "°F", um: "µm", ohm: "Ω", thou: "mil", inch: "in" };
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
  if (quantity.value === null) return quantity.reason ?? "none";
  return [written(quantity.value), unit(quantity.unit)].filter(Boolean).join(" ");
}

function written(value) {
  if (typeof value === "number") return plain(value);
  if (!Array.isArray(value)) return String(value);
  const items = value.length <= 6 ? value.map(written) : null;
  return items ? `[${items.join(", ")}]` : `[${written(value[0])} … ${written(value.at(-1))}] (${value.length} values)`;
}
