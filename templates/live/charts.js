// The charts of the report, drawn again from their declarations. Every point of a curve is a cell of the sheet.

const AROUND = [
  [0, 11, "middle"], [0, -5, "middle"], [6, 3, "start"], [-6, 3, "end"],
  [5, 9, "start"], [-5, -5, "end"], [-5, 9, "end"], [5, -5, "start"],
];
const BESIDE_END = [[5, 10, "start"], [-4, -4, "end"], [-6, -14, "end"], [-8, -26, "end"]];
const MOST_DOTS = 500, MOST_NAMES = 21, SOME_NAMES = 12, ROOM = 0.25, MARGINS = [0.06, 0.1], MOST_PANELS = 9, MOST_GROUPS = 8, IN_A_ROW = 3, GHOST = "#c4c4c4";

// From dark to middling, as the pictures that were issued.
const SHADES = [[68, 1, 84], [70, 50, 127], [54, 92, 141], [39, 127, 142], [31, 161, 135]];
function shade(part) {
  const place = part * (SHADES.length - 1), n = Math.min(Math.floor(place), SHADES.length - 2);
  return `rgb(${SHADES[n].map((from, k) => Math.round(from + (place - n) * (SHADES[n + 1][k] - from))).join(" ")})`;
}

// What a series shows, in units of these sizes, with these zeros: all rows, or those of each row of the axis that is repeated.
function tracesOf({ x, y, style, by }, { log }, { sheet, declared, words }, sizes) {
  if (style === "level") return [];
  const { value, status, layouts } = sheet, axis = axisNamed(declared[x].axis), of = by ? axisNamed(by) : axis.kind === "repeat" && axisNamed(axis.of);
  const { labels } = layouts[(of || axis).name], found = [];
  for (let row = 0; row < layouts[axis.name].size; row++) {
    const at = [x, y].map((name, n) => (value[name][row] - sizes[n][1]) / sizes[n][0]);
    if (status[x][row] || status[y][row] || at.some((one, n) => one <= 0 && log[n])) continue;
    const parent = of ? layouts[axis.name].rows[of.index][row] : row;
    const name = words[of?.name]?.[labels[parent]] ?? labels[parent].join("–"), part = parent / Math.max(1, labels.length - 1);
    (found[of ? parent : 0] ??= []).push({ at, row, name, part });
  }
  return found.filter(Boolean);
}

// The ends of both axes, and whether a point is drawn where it is: others must not shrink to nothing for its sake.
function frameOf({ log, zero, whole }, lines, dots) {
  const flat = (n, value) => (log[n] ? Math.log10(value) : value);
  const sorted = (points, n) => points.map(({ at }) => flat(n, at[n])).sort((a, b) => a - b);
  const allowed = [0, 1].map((n) => {
    const values = sorted(lines.length ? lines : dots, n), part = lines.length ? 0 : 0.25;
    const low = quantile(values, part), high = quantile(values, 1 - part);
    const reach = whole ? Infinity : lines.length ? ROOM * (high - low) : (n && 5 * (high - low)) || Infinity;
    return [low - reach, high + reach];
  });
  const holds = ({ at }) => at.every((one, n) => allowed[n][0] <= flat(n, one) && flat(n, one) <= allowed[n][1]);
  const ends = [0, 1].map((n) => {
    const values = sorted([...lines, ...dots.filter(holds)], n), low = values[0], high = values.at(-1);
    const room = MARGINS[n] * (high - low || 0.1 * Math.abs(high) || 1);
    if (log[n]) return [10 ** (low - room), 10 ** (high + room)];
    return [zero && low >= 0 ? 0 : low - room, high + room];
  });
  return { ends, holds };
}

// The lines of a series: one of each row that is repeated, the lowest first, or one through all points.
function waysOf({ each }, traces) {
  if (each) return [...traces].sort((a, b) => a.at(-1).at[1] - b.at(-1).at[1]);
  return traces.length > 1 ? [traces.flat().sort((a, b) => a.at[0] - b.at[0])] : traces;
}

const sameTraces = (some, others) => JSON.stringify(some) === JSON.stringify(others);

// A panel for each row of the axis that is repeated, of many for some; a line has the colour of its series.
function drawPanels({ height, log, panels }, series, own, ghosts, { ends }, titled, mark) {
  const named = new Map(own.flat().map(([{ row, name }]) => [name, row])), rows = [...named.keys()].sort((a, b) => named.get(a) - named.get(b));
  const shown = evenly(rows.length, MOST_PANELS).map((n) => rows[n]), across = Math.min(shown.length, IN_A_ROW);
  const keys = new Map(), width = WIDTH / across, legend = draw("g", {});
  series.forEach(({ label, colour }, n) => own[n].length && keys.set(plainOf(label), { mark: mark("M0 0h13", { stroke: colour, "stroke-width": 1.4 }), text: label }));
  if (ghosts.flat().length) keys.set("", { mark: mark("M0 0h13", { stroke: GHOST, "stroke-width": 2 }), text: [["", "as issued"]] });
  const top = Picture.prototype.key.call({ svg: legend }, [...keys.values()]) + 11;
  const svg = canvas(WIDTH, top + Math.ceil(shown.length / across) * height);
  shown.forEach((row, n) => {
    const picture = new Picture({ height, log, width, small: true }, ends, titled(["", `${panels} ${row}: `]), 14);
    for (const way of ghosts.flat()) if (way[0].name === row) picture.line(way, GHOST, 1);
    own.forEach((ways, of) => ways.forEach((way) => way[0].name === row && picture.line(way, series[of].colour, 1.2)));
    const transform = `translate(${(n % across) * width} ${top + Math.floor(n / across) * height})`;
    svg.append(draw("g", { transform }, ...picture.svg.childNodes));
  });
  svg.append(legend);
  return { svg, says: `${[...keys.values()].map(({ text }) => plainOf(text)).join("; ")}.` };
}

// A chart, or nothing if no cell that it shows has a value; a small one says less.
function drawChart(chart, look) {
  const { trace } = look, { value } = trace.sheet, series = chart.series.map((one) => ({ style: "line", colour: INK, ...one }));
  const units = ["x", "y"].map((axis) => {
    const { unit, size, from = 0, prefixes } = chart[axis];
    if (!prefixes) return [unit, size, from];
    const most = series.reduce((so, one) => value[one[axis]].reduce((a, b) => (Math.abs(b) > a ? Math.abs(b) : a), so), 0);
    const [sign, own] = prefixes.find((one) => most >= one[1]) ?? prefixes.at(-1);
    return [sign + unit, own, 0];
  });
  const own = series.map((one) => tracesOf(one, chart, trace, units.map(([, ...size]) => size)));
  // Under what an edit moved, in grey, what the report has as issued.
  const issued = look.issued ? series.map((one) => tracesOf(one, chart, look.issued.trace, units.map(([, ...size]) => size))) : [];
  const ghosts = issued.map((traces, n) => (sameTraces(traces, own[n]) ? [] : traces)), ghostly = series.map(({ style }, n) => (style === "line" ? ghosts[n]?.flat() ?? [] : [])).flat();
  const [lines, dots] = ["line", "points"].map((style) => own.flatMap((traces, n) => (series[n].style === style ? traces.flat() : [])));
  if (!lines.length && !dots.length) return null;
  const frame = frameOf(chart, [...lines, ...ghostly], dots), [x, y] = frame.ends, keys = [], names = [];
  const titled = (before = ["", ""]) => ["x", "y"].map((axis, n) => lettered([["", before[n]], ...chart[axis].title, ["", units[n][0] && ` / ${units[n][0]}`]]));
  const mark = (d, attributes) => draw("path", { d, ...attributes });
  if (chart.panels) return drawPanels(chart, series, own, ghosts, frame, titled, mark);
  const picture = new Picture(chart, frame.ends, titled(), chart.small ? 14 : series.some(({ by }) => by) || series.filter(({ style }) => style !== "level").length > 1 || !dots.every(frame.holds) || ghosts.some((traces) => traces.length) ? 33 : 4);
  const key = ({ label, rows, value }, count, more, sign) => {
    const told = label.map(([kind, text]) => [kind, text.replace("%s", `${count} ${rows?.[Number(count === 1)]}`)]);
    const text = [...told, ["", more + (value ? look.shownText(value, 0) : "")]];
    if (!keys.some((other) => plainOf(other.text) === plainOf(text))) keys.push({ mark: sign, text }); // both sides of a band are one
  };
  if (chart.base && y[0] < 0 && y[1] > 0) picture.line([{ at: [x[0], 0] }, { at: [x[1], 0] }], INK, 0.7, null, false);
  const draws = {
    level(one) {
      const at = (value[one.y][0] - units[1][2]) / units[1][1];
      if (!(at >= y[0] && at <= y[1])) return;
      picture.line([...Array(60).keys()].map((n) => ({ at: [x[0] + (n / 59) * (x[1] - x[0]), at] })), one.colour, 1, "5 3");
      const beside = (side, end) => [[x[end], at], [[side, -4, end ? "end" : "start"], [side, 11, end ? "end" : "start"]]];
      names.unshift([`${plainOf(one.label)}${look.shownText(one.y, 0)}`, [beside(4, 0), beside(-4, 1)], {}]);
    },
    line(one, traces) {
      const ways = waysOf(one, traces);
      const grouped = axisNamed(axisNamed(trace.declared[one.x].axis).of)?.kind === "groups"; // as its points
      const colour = (n) => (one.each ? shade(grouped ? ways[n][0].part : n / Math.max(1, ways.length - 1)) : one.colour);
      const width = one.each ? (ways.length <= SOME_NAMES ? 1.4 : 0.8) : 1.1;
      ways.forEach((way, n) => picture.line(way, colour(n), width));
      if (one.each) for (const n of evenly(ways.length, SOME_NAMES).reverse()) names.push([ways[n][0].name, [[ways[n].at(-1).at, BESIDE_END]], { colour: colour(n) }]);
      key(one, traces.length, "", mark("M0 0h13", { stroke: colour(Math.floor(ways.length / 2)), "stroke-width": width }));
    },
    points(one, traces) {
      if (one.by) {
        for (const own of traces) draws.points({ ...one, by: "", colour: shade(own[0].part), label: traces.length > MOST_GROUPS ? one.label : [["", own[0].name]] }, [own]);
        return;
      }
      const all = traces.flat(), few = all.length <= MOST_NAMES, within = all.filter(frame.holds), out = all.length - within.length;
      const middle = quantile(all.map(({ at }) => at[1]).sort((a, b) => a - b), 0.5), far = ({ at }) => Math.abs(at[1] - middle);
      const named = one.named ? [...all].sort((a, b) => far(b) - far(a)).slice(0, few ? Infinity : SOME_NAMES) : [];
      const shown = new Set([...evenly(within.length, MOST_DOTS).map((n) => within[n]), ...named.filter(frame.holds)]);
      const thinned = within.length > MOST_DOTS ? `, one in ${Math.round(within.length / MOST_DOTS)} drawn` : "";
      picture.dots([...shown].map(({ at }) => at), few ? 4.5 : 2.6, one.colour);
      const left = out && !one.named ? `; ${out} of ${all.length} ${out === 1 ? "lies" : "lie"} outside` : "";
      key(one, one.named ? all.length : traces.length, thinned + left, draw("circle", { cx: 6, r: 1.4, fill: one.colour }));
      for (const point of named) {
        const inside = frame.holds(point), at = point.at.map((value, n) => Math.min(Math.max(value, frame.ends[n][0]), frame.ends[n][1]));
        if (!inside) picture.arrow(at, point.at);
        const text = inside ? point.name : `${point.name}: ${LIVE.columns[one.y] ? look.shownText(one.y, point.row) : `${figureText(rounded(point.at[1], Math.min(0, order(point.at[1]) - 1)))} ${units[1][0]}`}`;
        names.push([text, [[at, inside ? AROUND : AROUND.slice(0, 2)]], { size: 8.5 }]);
      }
      if (out && one.named) keys.push({ mark: mark("M3 2h6l-3-5z", { fill: LOADING }), text: [["", `outside the frame: ${out} of ${all.length}`]] });
    },
  };
  ghosts.forEach((traces, n) => {
    if (series[n].style === "line") for (const way of waysOf(series[n], traces)) picture.line(way, GHOST, 1, null, false);
    else if (traces.length) picture.dots(traces.flat().filter(frame.holds).map(({ at }) => at), 3, GHOST, false);
  });
  if (ghosts.some((traces) => traces.length)) keys.push({ mark: mark("M0 0h13", { stroke: GHOST, "stroke-width": 2 }), text: [["", "as issued"]] });
  series.forEach((one, n) => (own[n].length || one.style === "level") && draws[one.style](one, own[n]));
  for (const [text, places, style] of names) places.some(([at, beside]) => picture.label(text, at, beside, style));
  if (picture.frame.top > 14) picture.key(keys);
  return { svg: picture.svg, says: `${keys.map(({ text }) => plainOf(text)).join("; ")}.` };
}
