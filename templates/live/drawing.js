// What every picture drawn in the page is made with: a frame, scales and ticks, texts that find room.
// Measures are points of print, as in the pictures that were issued.

const WIDTH = 453.54, SMALL = { width: 226, height: 97, small: true }, INK = "#1a1a1a", LOADING = "#d55e00";
const FONT = "'DejaVu Sans', Verdana, 'Noto Sans', 'Liberation Sans', Arial, sans-serif";

// Round numbers between two ends: their distance is 1, 2, 2.5 or 5 times a power of ten.
function ticks(low, high, most) {
  const rough = (high - low) / most || 1, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 2.5, 5, 10].find((size) => size * power >= rough * (1 - 1e-9)) * power;
  const first = Math.ceil(low / step - 1e-9), found = [];
  for (let n = first; n * step <= high + step * 1e-9; n++) found.push(n * step);
  const places = Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) + (String(step / power).startsWith("2.5") ? 1 : 0);
  return found.map((at) => ({ at, text: at.toFixed(Math.min(places, 12)).replace("-", MINUS) }));
}

// A width that is near enough to keep texts apart.
const textWidth = (text, size) => size * [...text].reduce((sum, c) => sum + (/[ijl.,:;|' ]/.test(c) ? 0.32 : /[mwMW]/.test(c) ? 0.93 : 0.61), 0);

// Powers of ten, if there are two between the ends; of many every other one, or fewer.
function logTicks(low, high, most) {
  const first = Math.ceil(Math.log10(low)), last = Math.floor(Math.log10(high)), step = Math.max(1, Math.ceil((last - first) / most));
  const found = [];
  for (let power = first; power <= last; power += step) found.push({ at: 10 ** power, text: brief(10 ** power) });
  return found.length > 1 ? found : ticks(low, high, most);
}

const canvas = (width, height) => draw("svg", {
  role: "img", viewBox: `0 0 ${width} ${height}`, width: Math.round((width * 4) / 3), height: Math.round((height * 4) / 3),
  "font-family": FONT, "font-size": "9", fill: INK, class: "picture",
}, draw("rect", { width, height, fill: "#fff" }));

class Picture {
  constructor({ height, log, width = WIDTH, small }, limits, titles, top) {
    const marks = (n, most) => (log[n] ? logTicks : ticks)(...limits[n], most);
    const yTicks = marks(1, small ? 4 : Math.min(9, (height - 60) / 24));
    const lines = small ? [titles[1]] : broken(titles[1], height - 36 - top);
    const left = 17 + 11 * lines.length + Math.max(...yTicks.map((tick) => textWidth(tick.text, 8.5)));
    this.frame = { left, right: width - 3, top, bottom: height - (small ? 25 : 36) };
    this.limits = limits;
    this.log = log;
    this.taken = [];
    this.svg = canvas(width, height);
    this.axes(marks(0, small ? 5 : 9), yTicks, [titles[0], lines], height, small);
  }

  // How far along an axis a value stands, from 0 to 1.
  part(n, value) {
    const [low, high, at] = [...this.limits[n], value].map(this.log[n] ? Math.log10 : Number);
    return (at - low) / (high - low);
  }

  x(value) {
    const { left, right } = this.frame;
    return left + this.part(0, value) * (right - left);
  }

  y(value) {
    const { top, bottom } = this.frame;
    return bottom - this.part(1, value) * (bottom - top);
  }

  axes(xTicks, yTicks, [xLabel, yLabels], height, small) {
    const { left, right, top, bottom } = this.frame, lines = [], marks = [], texts = [];
    for (const { at, text } of xTicks) {
      const x = this.x(at).toFixed(2);
      lines.push(`M${x} ${bottom}V${top}`);
      marks.push(`M${x} ${bottom}v3.5`);
      texts.push(draw("text", { x, y: bottom + 13, "text-anchor": "middle" }, text));
    }
    for (const { at, text } of yTicks) {
      const y = this.y(at).toFixed(2);
      lines.push(`M${left} ${y}H${right}`);
      marks.push(`M${left} ${y}h-3.5`);
      texts.push(draw("text", { x: left - 7, y: Number(y) + 3.1, "text-anchor": "end" }, text));
    }
    const middle = (top + bottom) / 2;
    this.svg.append(
      draw("path", { d: lines.join(""), stroke: "#e6e6e6", "stroke-width": 0.5 }),
      draw("path", { d: marks.join("") + `M${left} ${top}V${bottom}H${right}`, stroke: INK, "stroke-width": 0.7, fill: "none" }),
      draw("g", { "font-size": "8.5" }, ...texts),
      draw("text", { x: (left + right) / 2, y: height - (small ? 2 : 7), "text-anchor": "middle" }, ...xLabel),
      ...yLabels.map((line, n) => draw("text", small ? { x: 2, y: 9 } : { transform: `translate(${11 * (n + 1)} ${middle}) rotate(-90)`, "text-anchor": "middle" }, ...line)),
    );
  }

  // A path of a piece for each point, which texts keep clear of by a radius, if any.
  path(points, piece, attributes, radius) {
    const places = points.map(([x, y]) => [this.x(x), this.y(y)]);
    this.svg.append(draw("path", { d: places.map(piece).join(""), fill: "none", ...attributes }));
    if (radius) for (const [x, y] of places) this.avoid(x, y, radius);
  }

  // Dots as one path, each a stroke of no length with round ends.
  dots(points, size, stroke, keepClear = true) {
    this.path(points, ([x, y]) => `M${x.toFixed(1)} ${y.toFixed(1)}h0`, { stroke, "stroke-width": size, "stroke-linecap": "round" }, keepClear && 2);
  }

  // A line; one that leads nowhere to the side, as of a single point, has dots, too.
  line(points, stroke, width, dashes = null, keepClear = true) {
    const all = points.map(({ at }) => at), piece = ([x, y], n) => `${n ? "L" : "M"}${x.toFixed(2)} ${y.toFixed(2)}`;
    this.path(all, piece, { stroke, "stroke-width": width, "stroke-dasharray": dashes, "stroke-linejoin": "round" }, keepClear && 1);
    if (all.every(([x]) => x === all[0][0])) this.dots(all, 3, stroke, false);
  }

  // A triangle at the edge, towards a point that is outside.
  arrow([atX, atY], [x, y]) {
    const turn = y > atY ? 0 : y < atY ? 180 : x > atX ? 90 : 270;
    this.svg.append(draw("path", { d: "M-3 0h6l-3-5z", fill: LOADING, transform: `translate(${this.x(atX)} ${this.y(atY)}) rotate(${turn})` }));
  }

  avoid(x, y, radius) {
    this.taken.push([x - radius, y - radius, x + radius, y + radius]);
  }

  // A text at the first free of some places beside a point: [dx, dy, anchor]. Says whether there was one.
  label(text, [atX, atY], places, { size = 9, colour = INK } = {}) {
    const wide = textWidth(text, size), { left, right, top, bottom } = this.frame;
    for (const [dx, dy, anchor] of places) {
      const x = this.x(atX) + dx, y = this.y(atY) + dy;
      const from = anchor === "end" ? x - wide : anchor === "middle" ? x - wide / 2 : x;
      const box = [from, y - size * 0.78, from + wide, y + size * 0.12];
      const inside = box[0] >= left && box[2] <= right && box[1] >= top && box[3] <= bottom;
      if (!inside || this.taken.some(([a, b, c, d]) => a < box[2] && c > box[0] && b < box[3] && d > box[1])) continue;
      this.taken.push(box);
      const far = Math.max(Math.abs(dx), Math.abs(dy)) > 16;
      if (far) this.svg.append(draw("path", { d: `M${x} ${y}L${this.x(atX)} ${this.y(atY)}`, stroke: colour, "stroke-width": 0.5 }));
      this.svg.append(draw("text", { x: x.toFixed(1), y: y.toFixed(1), "text-anchor": anchor, "font-size": size, fill: colour }, text));
      return true;
    }
    return false;
  }

  // What the marks are, above the picture and beside a long title: [mark, letters], the mark an element around 0 0.
  key(entries) {
    let x = 24, y = 11;
    for (const { mark, text } of entries) {
      const plain = plainOf(text);
      if (x > 24 && x + 19 + textWidth(plain, 8.5) > WIDTH) [x, y] = [24, y + 11];
      const name = draw("text", { x: 19, y: 3.1, "font-size": 8.5 }, ...lettered(text));
      this.svg.append(draw("g", { transform: `translate(${x.toFixed(1)} ${y})` }, mark, name));
      x += 19 + textWidth(plain, 8.5) + 16;
    }
    return y;
  }
}

const plainOf = (letters) => letters.map(([, text]) => text).join("");

// A title in lines that are no longer than its axis, broken at blanks.
function broken(parts, most) {
  const lines = [[]];
  let wide = 0, last = "";
  for (const part of parts) {
    part.textContent.split(/(?<= )/).forEach((word, n) => {
      const long = textWidth(word, 9), piece = part.cloneNode(false);
      piece.textContent = word;
      if (n) piece.removeAttribute("dy");
      if (last.endsWith(" ") && wide + long > most) [wide] = [0, lines.push([])];
      lines.at(-1).push(piece);
      wide += long;
      last = word;
    });
  }
  return lines;
}

// Letters of a symbol are slanted; some stand lower or higher, and what follows back on the line.
function lettered(letters) {
  let low = 0;
  return letters.map(([kind, text]) => {
    const to = { _: 2, "^": -3 }[kind] ?? 0, dy = to - low;
    low = to;
    return draw("tspan", { "font-style": kind && "italic", dy: dy || null, "font-size": to ? "70%" : null }, text);
  });
}

// At most so many of the numbers 0 ... size - 1, evenly from the first to the last.
function evenly(size, most) {
  const count = Math.min(size, most);
  return Array.from({ length: count }, (_, n) => (count < 2 ? 0 : Math.round((n * (size - 1)) / (count - 1))));
}
