"use strict";
// Reads { module, pages: { name: html } } and writes what an HTML validator finds in each, one line a finding.

const fs = require("node:fs");
const { module: place, pages } = JSON.parse(fs.readFileSync(0, "utf8"));
const { HtmlValidate } = require(place);

(async () => {
  const validator = new HtmlValidate({ root: true, extends: ["html-validate:standard"] });
  const found = {};
  for (const [name, text] of Object.entries(pages)) {
    const { results } = await validator.validateString(text);
    found[name] = results.flatMap(({ messages }) => messages.map((one) => `${one.ruleId}: ${one.message} (${one.selector})`));
  }
  process.stdout.write(JSON.stringify(found));
})();
