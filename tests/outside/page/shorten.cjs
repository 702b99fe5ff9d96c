"use strict";
// Reads { module, scripts: { name: text }, kept: [name], parted: name } and writes each script as the page has it, without spaces and
// with short names. Those that are kept keep what stands outermost: the generated program calls it by its name; of the
// one that is parted, too, each part by itself.

const fs = require("node:fs");
const { module: place, scripts, kept, parted } = JSON.parse(fs.readFileSync(0, "utf8"));
const { minify } = require(place);

const COMPRESS = { ecma: 2022, passes: 3, unsafe_arrows: true, unsafe_methods: true };
// Nothing is assigned to a constant: one that varies is as good, and shorter.
const varying = (code) => code.replace(/\bconst /g, "let ");
const pick = (which) => Object.fromEntries(Object.entries(scripts).filter(([name]) => name !== parted && kept.includes(name) === which));
const called = Object.values(pick(true)).flatMap((text) => [...text.matchAll(/^(?:const|let|function\*?|class) +([\w$]+)/gm)]);

(async () => {
  const short = {};
  const shorten = async (texts, options) => {
    for (const [name, text] of Object.entries(texts)) short[name] = `${varying((await minify(text, { ecma: 2022, compress: COMPRESS, ...options })).code)}\n`;
  };
  const parts = Object.entries(scripts[parted].split(/\n\n+/).slice(1));
  await shorten({ ...pick(true), ...Object.fromEntries(parts) }, { mangle: true });
  short[parted] = parts.map(([place]) => short[place]).join("\n");
  for (const [place] of parts) delete short[place];
  // What the page's scripts call one another by is the same in all of them.
  const all = { mangle: { toplevel: true, reserved: called.map((found) => found[1]) }, nameCache: {} };
  await minify(pick(false), { ecma: 2022, ...all, compress: false });
  await shorten(pick(false), all);
  process.stdout.write(JSON.stringify(short));
})();
