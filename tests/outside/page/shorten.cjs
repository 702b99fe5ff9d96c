"use strict";
// Reads { module, scripts: { name: text }, kept: name } and writes each script as the page has it, without spaces and
// with short names. That of `kept` keeps what stands outermost: the generated program calls it by its name.

const fs = require("node:fs");
const { module: place, scripts, kept } = JSON.parse(fs.readFileSync(0, "utf8"));
const { minify } = require(place);

const COMPRESS = { ecma: 2022, passes: 2 };
const outermost = Array.from(scripts[kept].matchAll(/^(?:const|let|function\*?|class) +([\w$]+)/gm), (found) => found[1]);

(async () => {
  const { [kept]: runtime, ...own } = scripts, short = {};
  short[kept] = `${(await minify(runtime, { ecma: 2022, compress: COMPRESS, mangle: true })).code}\n`;
  // What the page's scripts call one another by is the same in all of them.
  const nameCache = {}, options = { ecma: 2022, mangle: { toplevel: true, reserved: outermost }, nameCache };
  await minify(own, { ...options, compress: false });
  for (const [name, text] of Object.entries(own)) short[name] = `${(await minify(text, { ...options, compress: COMPRESS })).code}\n`;
  process.stdout.write(JSON.stringify(short));
})();
