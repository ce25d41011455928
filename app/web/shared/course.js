// A long array in a table cell, as in app/presentation/environment.py: its extremes, their positions, a line.
import { FEW, extremes, plain, quantityText, unit } from "./numbers.js";

const SVG = "http://www.w3.org/2000/svg", WIDTH = 120, HEIGHT = 24, MOST_POINTS = 240;

export const isCourse = (values) =>
  Array.isArray(values) && values.length > FEW && !values.some(Array.isArray) && extremes(values) !== null;

export function courseCell(cell, quantity, axis) {
  const values = quantity.value, ends = extremes(values);
  const places = ends.map((end) => place(end, axis, values.length));
  const where = Object.assign(document.createElement("span"), { className: "muted where" });
  where.textContent = `${values.length} values; least ${places[0]}, largest ${places[1]}`;
  cell.classList.add("text");
  cell.colSpan = 2;
  cell.append(`${ends.map((end) => plain(values[end])).join(" … ")} ${unit(quantity.unit)} `, line(values, ends), " ", where);
  return cell;
}

function place(end, axis, count) {
  const isAlong = Array.isArray(axis?.value) && axis.value.length === count && typeof axis.value[end] === "number";
  return isAlong ? `at ${quantityText({ value: axis.value[end], unit: axis.unit })}` : `no. ${end + 1}`;
}

function line(values, [least, largest]) {
  const svg = document.createElementNS(SVG, "svg"), path = document.createElementNS(SVG, "path");
  svg.setAttribute("class", "spark");
  svg.setAttribute("viewBox", `0 0 ${WIDTH} ${HEIGHT}`);
  svg.setAttribute("preserveAspectRatio", "none");
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", "course");
  path.setAttribute("d", course(values, values[least], values[largest]));
  svg.append(path);
  return svg;
}

function course(values, low, high) {
  const every = Math.ceil(values.length / MOST_POINTS);
  let pieces = "", isDown = false;
  for (let place = 0; place < values.length; place += every) {
    const value = values[place], isNumber = typeof value === "number";
    if (isNumber) {
      const share = high > low ? (value - low) / (high - low) : 0.5;
      const x = (WIDTH * place) / (values.length - 1), y = 1 + (HEIGHT - 2) * (1 - share);
      pieces += `${isDown ? "L" : "M"}${x.toFixed(1)},${y.toFixed(1)}`;
    }
    isDown = isNumber;
  }
  return pieces;
}
