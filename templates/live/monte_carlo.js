// The results, and the cell in the formula bar, by Monte Carlo (JCGM 101): some hundred draws in a worker, a moment
// after an edit, which the next one ends. The page waits for nothing of it.

const DRAWS = 500, PAUSE = 200; // milliseconds in which nothing else was edited
const OFF = 0.25; // of a standard uncertainty, of which so many draws know a twentieth
const WITHOUT = 0.025, NO_DEVIATION = 2.2; // as the report has them
const TEXT = document.currentScript.textContent;
const carlo = { worker: null, timer: 0, look: null, found: {}, refused: false };

const draws = (look, name, row) => LIVE.shared && row >= 0 && look.trace.isOk(name, row) && !look.sure.lacking(name, row) && axisNamed(look.trace.declared[name].axis)?.kind !== "repeat" && !LIVE.columns[name].given;

// Every cell that is to be drawn: after an edit the results, and the one in the bar. Of all results,
// and of what U decides on, it is asked whether second order counts.
function cellsToDraw(look) {
  const rowsOf = (cells) => (isEdited() ? cells : []).map(([name, index]) => [name, look.trace.row(name, index)]), results = rowsOf(LIVE.headline), own = [bar.name, look.trace.row(bar.name, bar.index)];
  const some = (cells) => [...new Map(cells.map((cell) => [String(cell), cell])).values()].filter(([name, row]) => draws(look, name, row));
  const ruled = rowsOf(LIVE.decided.filter(({ times }) => times).map(({ of }) => of));
  return { looked: some([...results, ...ruled, own]).filter((cell) => !(cell in look.sure.more)), cells: some([...(page.panel ? results.slice(0, MOST_DRAWN) : []), own]).filter((cell) => !carlo.found[cell]) };
}

// Draws what was not drawn yet, soon; what was begun for another state ends.
function drawSoon() {
  const { look } = page;
  if (carlo.look !== look) Object.assign(carlo, { look, found: {} });
  clearTimeout(carlo.timer);
  carlo.worker?.terminate();
  const able = LIVE.shared && !carlo.refused;
  ROOT.dataset.draws = able ? "due" : "done";
  if (able) carlo.timer = setTimeout(() => drawNow(look), PAUSE);
}

function drawNow(look) {
  const { looked, cells } = cellsToDraw(look);
  if (!looked.length && !cells.length) {
    ROOT.dataset.draws = "done";
    return;
  }
  const names = (of) => of.map(([name]) => [name, ...look.trace.ancestors(name)]);
  const { labels, data } = look.trace.sheet, { errors, pairs } = look.sure, refuse = () => {
    carlo.refused = true;
    ROOT.dataset.draws = "done";
    tellDraws(look, []);
  };
  try {
    carlo.worker = new Worker((carlo.url ??= URL.createObjectURL(new Blob([TEXT], { type: "text/javascript" }))));
  } catch {
    refuse();
    return;
  }
  carlo.worker.onerror = refuse;
  carlo.worker.onmessage = ({ data: { more, found } }) => {
    if (found) carlo.worker.terminate();
    looked.forEach((cell, n) => more && look.sure.learn(cell, more[n]));
    cells.forEach((cell, n) => found && (carlo.found[cell] = toldBy(found[n])));
    tellDraws(look, more);
    if (found) ROOT.dataset.draws = "done";
  };
  const stated = errors.map(({ moves, shape, dof, sample }) => ({ moves, shape, dof, sample })), rough = looked.map(([name]) => LIVE.columns[name].rough ?? 0);
  carlo.worker.postMessage({ count: DRAWS, labels, data: centred(look, data), errors: stated, pairs, cells, names: names(cells), looked: { cells: looked, names: names(looked), rough } });
}

// What was given as it is expected to be: a truncated number is larger than what it says.
function centred(look, data) {
  const moved = CELLS.filter(({ name }) => LIVE.columns[name].given?.truncated);
  const by = (name) => look.texts(name).map((text, row) => expected(LIVE.columns[name], look.trace.index(name, row), text));
  return { ...data, ...Object.fromEntries(moved.map(({ name }) => [name, data[name].map((value, row) => value + by(name)[row])])) };
}

// What draws tell: the ends of 95 % with equal tails if nearly all have a value, and the standard uncertainty if the
// tails let one exist, by Hill's index.
function toldBy(sorted) {
  const { length } = sorted, lost = DRAWS - length, mean = sum(sorted) / length, most = Math.floor(Math.sqrt(length));
  const ends = lost > WITHOUT * DRAWS ? null : [0.025, 0.975].map((part) => quantile(sorted, part));
  const middle = quantile(sorted, 0.5), out = Array.from(sorted, (value) => Math.abs(value - middle)).sort((a, b) => a - b).slice(-most - 1);
  const slope = sum(out.slice(1).map((one) => Math.log(one / out[0]))) / most;
  const u = length > 1 && !(slope * NO_DEVIATION >= 1) ? Math.sqrt(sum(Array.from(sorted, (value) => (value - mean) ** 2)) / (length - 1)) : NaN;
  return { lost, u: u < Infinity ? u : NaN, ends };
}

function tellDraws(look, more) {
  if (look !== page.look) return;
  const { name, index } = bar, row = look.trace.row(name, index);
  if (isEdited() && more) [writeUncertain, writeDecided].forEach((write) => write(look));
  if (row >= 0 && more) {
    byId("bar-sure").hidden = true;
    fillSure(look, name, row);
  }
  tellStale();
  writePanel(look);
  fillDraws(look);
}

// From one end to the other, with the digits that the uncertainty lets them have and a power of ten once.
function rangeOf(name, { u, ends }) {
  const { scale, zero } = LIVE.columns[name], by = (u > 0 ? u : (ends[1] - ends[0]) / 4) / scale, both = ends.map((end) => (end - zero) / scale);
  if (!(by > 0)) return brief(both[0]);
  const [low, high] = alike(both, told(by, LIVE.most).place, Math.max(...both.map(Math.abs)));
  return `${figureText({ ...low, exponent: null })} … ${figureText(high)}`;
}

// Below the first order of the cell in the bar.
function fillDraws(look) {
  const { name, index } = bar, row = look.trace.row(name, index);
  byId("bar-draws").hidden = true;
  if (!draws(look, name, row)) return;
  const found = carlo.found[[name, row]], { scale } = LIVE.columns[name], says = make("span", { class: "says" }, `${DRAWS} draws`);
  if (carlo.refused || !found) {
    fillLine("bar-draws", says, carlo.refused ? "this browser lets no page draw in the background" : "…");
    return;
  }
  const { lost, u, ends } = found, words = u >= 0 ? ["u = ", figureText(stated(0, u / scale, LIVE.most)[1]), ...behind(name)] : ["tails too long for u"];
  words.push(...(ends ? [`, 95\u00a0% in ${rangeOf(name, found)}`, ...behind(name)] : [", too many without a value for an interval"]));
  fillLine("bar-draws", says, make("span", {}, ...words, lost ? `; ${lost} without a value over these rows` : ""));
  furnished(byId("bar-draws"), { "data-lost": lost, "data-u": u, "data-ends": ends ?? "" }, []);
}

// The same of a result, for the panel.
function shortDraws(name, row) {
  const found = carlo.found[[name, row]];
  if (!found) return carlo.refused || !draws(page.look, name, row) ? "–" : "…";
  return found.ends ? rangeOf(name, found) : `${found.lost} of ${DRAWS} draws without a value`;
}
