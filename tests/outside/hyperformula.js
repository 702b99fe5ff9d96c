"use strict";
// Recalculates workbooks with HyperFormula. Reads {module, books: {name: {worksheet: {address: cell}}}} from
// standard input, array formulas in braces, and writes every value in the same shape, after the `changes` of
// rows in a book: a worksheet, the row from 0, and how many are put in (or, below zero, taken out). With
// `edits`, cells that are typed into the first book in the shape of a book, it also writes all values after each
// of them; with `mutants`, lists of worksheet, address and formula, it also says of each how many cells of the
// first book it changes.
const { readFileSync } = require("node:fs");
const { books, changes = {}, edits = {}, mutants = [], module: path } = JSON.parse(readFileSync(0, "utf8"));
const { HyperFormula, DetailedCellError } = require(path);

// Nothing is rounded, and nothing small is taken for zero: the comparison is to the last digits.
const options = { licenseKey: "gpl-v3", smartRounding: false, useArrayArithmetic: false };
function entered(cell) {
  return typeof cell === "string" && cell.startsWith("{=") ? `=ARRAYFORMULA(${cell.slice(2, -1)})` : cell ?? null;
}

function differs(before, after) {
  return typeof before === "number" && typeof after === "number" ? before !== after : String(before) !== String(after);
}

const out = {};
for (const [name, worksheets] of Object.entries(books)) {
  const sheets = {};
  for (const [worksheet, cells] of Object.entries(worksheets)) {
    const rows = [];
    for (const [address, cell] of Object.entries(cells)) {
      const [, letters, number] = /^([A-Z]+)(\d+)$/.exec(address);
      const column = [...letters].reduce((sum, letter) => sum * 26 + letter.charCodeAt(0) - 64, 0) - 1;
      const row = (rows[Number(number) - 1] ??= []);
      row[column] = entered(cell);
    }
    sheets[worksheet] = Array.from(rows, (row) => Array.from(row ?? [], (cell) => cell ?? null));
  }
  const engine = HyperFormula.buildFromSheets(sheets, options);
  for (const [worksheet, row, number] of changes[name] ?? []) {
    const sheet = engine.getSheetId(worksheet);
    if (number > 0) engine.addRows(sheet, [row, number]);
    else engine.removeRows(sheet, [row, -number]);
  }
  const at = (worksheet, address) => {
    const sheet = engine.getSheetId(worksheet);
    return { ...engine.simpleCellAddressFromString(address, sheet), sheet };
  };
  const each = (cells, of) =>
    Object.fromEntries(
      Object.entries(cells).map(([worksheet, own]) => [
        worksheet,
        Object.fromEntries(Object.entries(own).map(([address, cell]) => [address, of(worksheet, address, cell)])),
      ]),
    );
  const values = () =>
    each(worksheets, (worksheet, address) => {
      const value = engine.getCellValue(at(worksheet, address));
      return value instanceof DetailedCellError ? value.value : value;
    });
  const type = (worksheet, address, cell) => engine.setCellContents(at(worksheet, address), entered(cell));
  const first = Object.keys(out).length === 0;
  out[name] = values();
  for (const [edit, cells] of Object.entries(first ? edits : {})) {
    each(cells, type);
    out[edit] = values();
    each(cells, (worksheet, address) => type(worksheet, address, worksheets[worksheet][address]));
  }
  if (mutants.length && out.mutants === undefined) {
    const before = engine.getAllSheetsValues();
    out.mutants = mutants.map(([worksheet, address, formula]) => {
      const changes = type(worksheet, address, formula);
      const value = (change) => (change.newValue instanceof DetailedCellError ? change.newValue.value : change.newValue);
      const number = changes.filter((change) => {
        if (change.address === undefined) return true;
        const { sheet: own, row, col } = change.address;
        return differs(before[engine.getSheetName(own)][row][col], value(change));
      }).length;
      type(worksheet, address, worksheets[worksheet][address]);
      return number;
    });
  }
  engine.destroy();
}
process.stdout.write(JSON.stringify(out));
