// The pictures that follow the values. Every point of a curve is a cell of the sheet: no force law is here.

const AROUND = [
  [0, 11, "middle"], [0, -5, "middle"], [6, 3, "start"], [-6, 3, "end"],
  [5, 9, "start"], [-5, -5, "end"], [-5, 9, "end"], [5, -5, "start"],
];
const BESIDE_TIP = [[5, 10, "start"], [-4, -4, "end"], [-6, -14, "end"], [-8, -26, "end"]];
const MOST_DOTS = 500, ROOM = 1.25;

// From dark to middling, as the pictures that were issued.
const SCALE = [[68, 1, 84], [70, 50, 127], [54, 92, 141], [39, 127, 142], [31, 161, 135]];
function loopColour(part) {
  const place = part * (SCALE.length - 1), n = Math.min(Math.floor(place), SCALE.length - 2);
  return `rgb(${SCALE[n].map((from, k) => Math.round(from + (place - n) * (SCALE[n + 1][k] - from))).join(" ")})`;
}

// The points of two columns of one axis where both have values, for each row of the axis it repeats:
// [name of the row, its points].
function pointsOf(trace, xName, yName, xScale) {
  if (!trace.declared[xName] || !trace.declared[yName]) return [];
  const { value, status, layouts } = trace.sheet, axis = PROGRAM.axes.find((one) => one.name === trace.declared[xName].axis);
  const parent = PROGRAM.axes.find((one) => one.name === axis.of), which = layouts[axis.name].rows[parent.index];
  const xs = value[xName], ys = value[yName], badX = status[xName], badY = status[yName], found = [];
  for (let row = 0; row < xs.length; row++) {
    if (badX[row] === STATUS.OK && badY[row] === STATUS.OK) (found[which[row]] ??= []).push([xs[row] / xScale, ys[row]]);
  }
  return found.map((points, n) => [layouts[parent.name].labels[n].join("–"), points]).filter(Boolean);
}

const largest = (points, place) => {
  let most = 0;
  for (const point of points) if (point[place] > most) most = point[place];
  return most;
};

function drawLoops(look) {
  const { trace } = look, depth = LIVE.columns.x_m;
  const points = pointsOf(trace, "x", "F", depth.scale), up = pointsOf(trace, "loading_x", "loading_F", depth.scale);
  const back = pointsOf(trace, "unloading_x", "unloading_F", depth.scale);
  const every = points.flatMap(([, own]) => own);
  const fit = up.reduce((a, [, b]) => (largest(b, 0) > largest(a, 0) ? b : a), []);
  if (!every.length) return null;
  const most = Math.max(largest(every, 1), largest(fit, 1));
  const [unit, size] = [["MN", 1e6], ["kN", 1e3], ["N", 1], ["mN", 1e-3]].find(([, one]) => most >= one) ?? ["mN", 1e-3];
  const scaled = (list) => {
    for (const point of list) point[1] /= size;
    return list;
  };
  const dots = scaled(every), curve = scaled(fit);
  const right = Math.min(largest(dots, 0), curve.length ? ROOM * largest(curve, 0) : Infinity);
  const top = Math.min(largest(dots, 1), curve.length ? ROOM * largest(curve, 1) : Infinity);
  const within = dots.filter(([x, y]) => x <= right && y <= top);
  const shown = evenly(within.length, MOST_DOTS).map((n) => within[n]);
  const picture = new Picture(283.46, {
    x: [0, 1.05 * Math.max(right, largest(curve, 0))], y: [0, 1.06 * Math.max(top, largest(curve, 1))], top: 28,
    xLabel: ["approach ", italic("x"), ` / ${unitLabel(depth.unit)}`], yLabel: ["force ", italic("F"), ` / ${unit}`],
  });
  picture.dots(shown, 2.6, LOADING);
  const ways = back.map(([label, way]) => ({ label, way: scaled(way) })).filter(({ way }) => way.length > 1);
  ways.sort((a, b) => a.way.at(-1)[1] - b.way.at(-1)[1]);
  const colour = (n) => loopColour(n / Math.max(1, ways.length - 1));
  ways.forEach(({ way }, n) => picture.line(way, colour(n), ways.length <= 12 ? 1.4 : 0.8, "restitution"));
  if (curve.length) picture.line(curve, INK, 1.1, "compression");
  for (const n of evenly(ways.length, 12).reverse()) picture.label(ways[n].label, ways[n].way.at(-1), BESIDE_TIP, { colour: colour(n) });
  let named = points.length > 1 ? `points of ${points.length} pairs` : "points of the pair";
  if (shown.length < within.length) named += `, one in ${Math.round(within.length / shown.length)} drawn`;
  if (within.length < dots.length) named += `; ${dots.length - within.length} of ${dots.length} lie outside`;
  const stroke = (of, width) => draw("path", { d: "M0 0h13", stroke: of, "stroke-width": width });
  const entries = [{ mark: draw("circle", { cx: 6, r: 1.4, fill: LOADING }), text: [named], plain: named }];
  if (curve.length) {
    const exponent = look.shownText("alpha_log", 0), plain = `compression fitted to them, α = ${exponent}`;
    entries.push({ mark: stroke(INK, 1.1), text: ["compression fitted to them, ", italic("α"), ` = ${exponent}`], plain });
  }
  if (ways.length) {
    const text = "restitution of each test";
    entries.push({ mark: stroke(colour(Math.floor(ways.length / 2)), 1.4), text: [text], plain: text });
  }
  picture.key(entries);
  const says = `${points.length} pairs, ${plural(ways.length, "test")} with a closed loop, approaches up to ${brief(Number(largest(dots, 0).toPrecision(3)))} ${depth.unit}.`;
  return { svg: picture.svg, says };
}

function drawAlphaPairs(look) {
  const { trace } = look, { layouts, value } = trace.sheet, speed = LIVE.columns.v;
  const { digits } = look.column("alpha"), column = trace.declared.alpha, layout = layouts[column.axis];
  const axis = PROGRAM.axes.find((one) => one.name === column.axis);
  const pairs = [];
  for (let row = 0; row < layout.size; row++) {
    if (!trace.isOk("alpha", row)) continue;
    const ends = [axis.first, axis.second].map((index) => value.v[layout.rows[index][row]]);
    pairs.push({ at: [(ends[0] + ends[1]) / 2 / speed.scale, value.alpha[row]], label: layout.labels[row].join("–") });
  }
  if (!pairs.length) return null;
  const ys = pairs.map(({ at }) => at[1]).sort((a, b) => a - b), xs = pairs.map(({ at }) => at[0]);
  const part = (q) => {
    const place = q * (ys.length - 1), n = Math.floor(place);
    return ys[n] + (place - n) * ((ys[n + 1] ?? ys[n]) - ys[n]);
  };
  const middle = part(0.5), reach = 5 * (part(0.75) - part(0.25)) || Infinity;
  const fences = [part(0.25) - reach, part(0.75) + reach];
  const few = pairs.length <= 45, isBeyond = ({ at }) => at[1] < fences[0] || at[1] > fences[1];
  const outermost = [...pairs].sort((a, b) => Math.abs(b.at[1] - middle) - Math.abs(a.at[1] - middle));
  const drawn = new Set([...evenly(pairs.length, MOST_DOTS).map((n) => pairs[n]), ...outermost.slice(0, 12)]);
  const inside = [...drawn].filter((pair) => !isBeyond(pair)), beyond = [...drawn].filter(isBeyond);
  const mean = trace.isOk("alpha_mean", 0) ? value.alpha_mean[0] : null;
  const heights = inside.map(({ at }) => at[1]);
  const picture = new Picture(226.77, {
    x: margins(Math.min(...xs), Math.max(...xs), 0.06), y: margins(Math.min(...heights), Math.max(...heights), 0.1),
    xLabel: [`mean impact speed of the pair / ${unitLabel(speed.unit)}`], yLabel: ["exponent ", italic("α"), " of the pair"],
  });
  const [low, high] = picture.limits.y, [left, right] = picture.limits.x;
  picture.dots(inside.map(({ at }) => at), few ? 4.5 : 2.2, UNLOADING);
  for (const pair of beyond) {
    const up = pair.at[1] > middle, edge = up ? high : low, x = picture.x(pair.at[0]), y = picture.y(edge);
    picture.svg.append(draw("path", { d: `M${x - 2.5} ${y}h5l-2.5 ${up ? -4 : 4}z`, fill: LOADING }));
    pair.held = [pair.at[0], edge];
  }
  if (mean !== null && mean >= low && mean <= high) {
    picture.line([...Array(60).keys()].map((n) => [left + (n / 59) * (right - left), mean]), INK, 1, "mean", "5 3");
    const text = `mean ${look.shownText("alpha_mean", 0)}`;
    picture.label(text, [left, mean], [[4, -4, "start"], [4, 11, "start"]])
      || picture.label(text, [right, mean], [[-4, -4, "end"], [-4, 11, "end"]]);
  }
  for (const pair of few ? outermost : outermost.slice(0, 12)) {
    const text = pair.held ? `${pair.label}: ${figureText(rounded(pair.at[1], digits))}` : pair.label;
    picture.label(text, pair.held ?? pair.at, pair.held ? AROUND.slice(0, 2) : AROUND, { size: 8.5 });
  }
  const ends = `${figureText(rounded(ys[0], digits))} to ${figureText(rounded(ys.at(-1), digits))}`;
  return { svg: picture.svg, says: `${plural(pairs.length, "pair")}, exponents from ${ends}.` };
}

function margins(low, high, share) {
  const span = high - low || Math.abs(high) * 0.1 || 1;
  return [low - share * span, high + share * span];
}

const DRAWINGS = { loops: drawLoops, alpha_pairs: drawAlphaPairs };
