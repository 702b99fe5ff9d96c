// What is known of readings by how they scatter (JCGM 100, 4.2.2 and C.3.4). It follows an edit, and a row that is left out
// or added. Only the page of a report with such columns has this file.

// The numbers of columns, beside one another, in the rows that have them all.
function readings(look, names) {
  const { value } = look.trace.sheet, rows = [...value[names[0]].keys()].filter((row) => names.every((name) => look.trace.isOk(name, row)));
  return names.map((name) => rows.map((row) => value[name][row]));
}

// Without rounding where all numbers are one.
function covariance(one, other) {
  const means = [one, other].map((all) => (all.every((x) => x === all[0]) ? all[0] : sum(all) / all.length));
  return sum(one.map((x, row) => (x - means[0]) * (other[row] - means[1]))) / (one.length - 1);
}

// A column with the errors that its numbers have by their scatter. Where they are all the same it is what their digits
// leave (F.2.2.1); of one number alone nobody knows.
function withScatter(look, name) {
  const column = LIVE.columns[name], { errors } = column;
  if (!(Array.isArray(errors) && errors.some(({ scatter }) => scatter))) return column;
  const [numbers] = readings(look, [name]), u = Math.sqrt(covariance(numbers, numbers)), dof = numbers.length - 1;
  const none = dof < 1 ? UNKNOWN : errors.length === 1 ? OF_DIGITS : [{}];
  return { ...column, errors: errors.map((error) => (error.scatter ? { ...error, ...(u ? { u, dof } : { dof: undefined, sample: undefined, ...none[0] }) } : error)) };
}

// How the errors of columns are correlated: as was stated, and as readings are that were taken together.
function correlations(look) {
  const all = LIVE.paired.length ? readings(look, LIVE.paired) : [], found = all.map((own) => Math.sqrt(covariance(own, own)));
  const paired = all.flatMap((one, n) => all.slice(0, n).map((other, m) => [LIVE.paired[m], LIVE.paired[n], covariance(one, other) / (found[n] * found[m])]));
  return [...LIVE.correlated, ...paired.filter(([, , r]) => Number.isFinite(r))];
}
