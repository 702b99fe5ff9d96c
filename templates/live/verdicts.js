// Sentences that judge a sum of squares: their probability follows an edit while they say what is so, and else they say
// that they no longer do. So do decisions on limits. What no script can compute again says that it is as issued.

// How likely a sum of squares is at least, and at most, so large, of so many independent standard normal numbers: from
// one or two of them on, every two more add a term.
function squares(chi2, dof) {
  const x = chi2 / 2, root = Math.sqrt(x / Math.PI);
  let a = dof % 2 ? 0.5 : 1, term = (a < 1 ? 2 * root : x) * Math.exp(-x), tail = Math.exp(-x);
  const rest = () => {
    let all = term;
    for (let one = term, n = a + 1; one > all * 1e-17; n++) all += one *= x / n;
    return all;
  };
  if (a < 1 && x < 2) tail = 1 - rest();
  else if (a < 1) {
    // The complementary error function of the root of x, by Laplace's continued fraction.
    const z = Math.sqrt(x);
    let below = z;
    for (let n = 100; n; n--) below = z + n / 2 / below;
    tail *= 1 / Math.sqrt(Math.PI) / below;
  }
  for (; a < dof / 2; a++) [tail, term] = [tail + term, term * x / (a + 1)];
  return { tail, head: tail < 0.5 ? 1 - tail : rest() };
}

// The probability of a sum of squares as a text, and what is said of it.
function judged({ trace: { sheet } }, name, kind) {
  const [axis, fitted] = LIVE.squares[name], dof = (sheet.counted[name]?.[axis] ?? sheet.layouts[axis].size) - fitted;
  if (!(dof > 0) || sheet.status[name][0]) return { text: "", says: "" };
  const found = squares(sheet.value[name][0], dof), p = found[kind], [rare, least] = LIVE.chances;
  const text = p < least ? `below ${figureText(rounded(least, order(least)))}` : p < 1 ? figureText(rounded(p, Math.min(order(p), order(1 - p)))) : "1";
  return { text, says: found.tail < rare ? "unlikely" : found.head < rare ? "close" : "likely" };
}

const stale = (text) => make("span", { class: "stale" }, text);

function writeVerdicts(look) {
  for (const note of all("main .note > p")) {
    const place = note.querySelector("[data-tail], [data-head]"), olds = all(".stale", note);
    if (!place && olds.length) continue;
    for (const old of olds) old.remove();
    if (place) {
      const [[kind, name]] = Object.entries(place.dataset), [then, now] = [look.issued, look].map((one) => judged(one, name, kind));
      setText(place, (then.says === now.says ? now : then).text);
      place.classList.toggle("changed", then.says === now.says && then.text !== now.text);
      if (then.says === now.says) continue;
      note.append(stale(` With the edits ${now.text ? `it is ${now.text}` : "there is none"}: this no longer holds.`));
    }
    note.prepend(stale("As issued, before the edits: "));
  }
}

// --- limits ----------------------------------------------------------------------------------------------

// What is decided on a cell with limits (JCGM 106, 8), as a build decides it: by U of first order where second order does
// not count, which a worker has to look at first. Empty where only a build can tell.
function decided(look, { of: [name, index], ends: [low, high], times, width = 0, build }) {
  const row = look.trace.row(name, index), given = LIVE.columns[name].given;
  if (row < 0 || !look.trace.isOk(name, row)) return "has no value: no decision";
  const value = look.trace.sheet.value[name][row], [least, most] = [low ?? -Infinity, high ?? Infinity];
  const slack = Math.abs(value) * 2 ** -48; // a build has the double nearest to it, which may be the limit
  if (value < least - slack || value > most + slack) return "does not conform";
  const u = times && LIVE.shared ? look.sure.u(name, row) : NaN, more = given ? 0 : look.sure.more[[name, row]];
  if (build || (times && (Number.isNaN(u) || (more !== undefined && more !== 0)))) return "";
  if (times && more === undefined) return carlo.refused ? "" : "…";
  const guard = times && u ? times * look.sure.budget(name, row).factor * u : width;
  if (Number.isNaN(guard)) return "";
  return least + guard <= value + slack && value - slack <= most - guard ? "conforms" : least + guard > most - guard ? "no decision: the guard bands meet" : "lies in the guard band: no decision";
}

function writeDecided(look) {
  const isNew = (name) => Array.from(look.trace.sheet.value[name].keys()).some((row) => page.issued.trace.row(name, look.trace.index(name, row)) < 0);
  const told = LIVE.decided.flatMap((rule, n) => [n ? "; " : " With them: ", make("code", {}, rule.cell), ` ${decided(look, rule) || "is decided by a build"}`]);
  page.decided?.replaceChildren(...told, LIVE.decided.some(({ of: [name, index] }) => index && isNew(name)) ? "; of new rows a build decides." : ".");
}
