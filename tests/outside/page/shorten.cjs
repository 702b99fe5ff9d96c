"use strict";
// Reads { module, scripts: { name: text } } and writes each as the page has it: short names within functions, no spaces.

const fs = require("node:fs");
const { module: place, scripts } = JSON.parse(fs.readFileSync(0, "utf8"));
const { minify } = require(place);

// What stands outermost keeps its name: the scripts and the generated program call one another by it.
const OPTIONS = { ecma: 2022, compress: { ecma: 2022, passes: 2 }, mangle: true, toplevel: false };

(async () => {
  const short = {};
  for (const [name, text] of Object.entries(scripts)) short[name] = `${(await minify(text, OPTIONS)).code}\n`;
  process.stdout.write(JSON.stringify(short));
})();
