// Edits outlive the page: the browser keeps them, and a link carries them. What comes back is foreign text, read
// as strictly as a file; what does not fit this very issue of the report is left alone, with a word.

const OURS = `loopsheet ${location.pathname} `, MINE = OURS + LIVE.issue, IN_LINK = "#edits=";
const MOST_STEPS = 50; // edits that can be undone after a reload
const MOST_MORE = 300; // tests that a link may add: the work grows with the square of their number
const lasting = { safe: null }; // the state that was saved or copied

// What foreign text holds as states of this report, one after the other; null if it is none.
function readStates(read, more = Infinity) {
  try {
    const found = JSON.parse(read());
    return found.length ? found.map((one) => stateIn(one, more)) : null;
  } catch {
    return null;
  }
}

function stateIn(found, more) {
  const texts = (from, wanted) => Object.fromEntries(Object.keys(wanted).map((name) => [name, plainText(from[name])]));
  const state = { tables: {}, parameters: texts(found.parameters, LIVE.parameters) };
  for (const [axis, { rows }] of Object.entries(LIVE.tables)) {
    const all = found.tables[axis];
    if (all.length > rows.length + more) throw new RangeError("too many tests");
    state.tables[axis] = all.map(({ label, used, reason, cells }) => {
      if (!Number.isSafeInteger(label) || label < 1 || label >= 1e9) throw new RangeError("no number of a test");
      return { label, used: used === true, reason: plainText(reason), cells: texts(cells, rows[0].cells) };
    });
    if (!enough(state, axis) || new Set(all.map(({ label }) => label)).size < all.length) throw new RangeError("no such tests");
  }
  return state;
}

function plainText(text) {
  if (typeof text !== "string" || text.length > 500 || /\p{Cc}|\p{Cs}|[\u2028\u2029]/u.test(text)) throw new TypeError("no plain text");
  return text;
}

// --- in the browser ----------------------------------------------------------------------------------------

// Runs what uses the memory of the browser, which it may refuse.
function remembering(action) {
  try {
    return action(localStorage);
  } catch {
    return undefined;
  }
}

function keepStates(edited) {
  const states = JSON.stringify(edited ? page.history.last(MOST_STEPS) : []);
  byId("live-issued").dataset.edits = states;
  const done = remembering((memory) => {
    if (edited) memory.setItem(MINE, states);
    else memory.removeItem(MINE);
    return true;
  });
  if (edited && !done) note("This browser keeps no edits of this page. Save them, or copy a link to them, before you close it.");
}

// A browser that stores the page as it stands stores edited numbers, and what scripts put beside them. Such a page has
// with it what was issued, and the edits: read again, it begins with the one and goes on from the others.
function unstored() {
  const stored = byId("live-issued"), main = byId("main");
  if (stored) {
    main.replaceChildren(stored.content.cloneNode(true));
    ROOT.removeAttribute("data-edited");
    return;
  }
  const issued = make("template", { id: "live-issued" });
  issued.content.append(...main.cloneNode(true).childNodes);
  byId("live-dock").before(issued); // read before this script is
}

// Takes edits that were kept as text, each a step that can be undone; nothing if they cannot be read.
function takeUp(text) {
  const states = readStates(() => text);
  for (const state of states ?? []) page.history.push(state);
  return states;
}

function recall() {
  const { edits } = byId("live-issued").dataset;
  if (edits && takeUp(edits)) note("These edits were stored with the page. Undo leads back.");
  const own = remembering((memory) => memory.getItem(MINE));
  if (own) {
    note(takeUp(own) ? "Your edits of last time are here again." : "What this browser kept of your edits cannot be read; it was not used.");
  } else if (remembering(keepsOthers)) {
    note("This browser keeps edits of another issue of this report. They are not used here.");
  }
  followLink();
}

// Whether edits of other issues are kept. They stay where they are, but for those that this issue was built from.
function keepsOthers(memory) {
  const others = Object.keys(memory).filter((key) => key.startsWith(OURS)), issued = asBuilt(page.history.issued);
  return others.filter((key) => {
    const state = readStates(() => memory.getItem(key))?.at(-1), arrived = state && asBuilt(state) === issued;
    if (arrived) memory.removeItem(key);
    return !arrived;
  })[0];
}

// What another window of this very report keeps is shown here too: neither then writes over the other.
function followOther({ key, newValue }) {
  const state = key !== MINE ? null : newValue ? readStates(() => newValue)?.at(-1) : page.history.issued;
  if (!state || sameState(state, page.history.now)) return;
  page.history.push(state);
  show();
  note("Edited in another window. Undo leads back.");
}

// --- in a link ---------------------------------------------------------------------------------------------

function linkTo(state) {
  const bytes = new TextEncoder().encode(JSON.stringify(state));
  const text = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  return `${IN_LINK}${LIVE.issue}.${text.replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "")}`;
}

function ofLink(text) {
  const states = readStates(() => {
    const bytes = Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (one) => one.charCodeAt(0));
    return `[${new TextDecoder("utf-8", { fatal: true }).decode(bytes)}]`;
  }, MOST_MORE);
  return states?.at(-1) ?? null;
}

// Whether the address carries edits that were taken. They are taken once: what is edited then lasts by itself.
function followLink() {
  if (!location.hash.startsWith(IN_LINK)) return false;
  const [issue, text] = location.hash.slice(IN_LINK.length).split("."), state = issue === LIVE.issue ? ofLink(text ?? "") : null;
  remembering(() => history.replaceState(null, "", location.pathname + location.search));
  if (state) page.history.push(state);
  if (state) note("These edits came with the link. Undo leads back.");
  else if (issue === LIVE.issue) note("The edits in this link are damaged; they were not used.");
  else note("This link carries edits of another report, or of another issue of this one; they were not used.");
  return state !== null;
}

function shareLink() {
  const { now } = page.history, { href } = new URL(linkTo(now), location.href);
  const link = make("a", { href }, "link to these edits");
  copyText({ plain: href, html: asMarkup(link) });
  lasting.safe = now;
  note("Copied: a ", link, ".");
}

// --- closing -----------------------------------------------------------------------------------------------

function onLeave(event) {
  commit();
  if (sameState(page.history.now, page.history.issued) || page.history.now === lasting.safe) return;
  handled(event);
  event.returnValue = true; // what older browsers ask for
}
