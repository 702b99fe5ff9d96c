// Numbers as text and back, exactly: the page reads and prints them as the program that issued it does.
// Nothing in this file knows the page.

const MINUS = "\u2212", THIN = "\u202f", RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹";
const NUMBER = /^([+-]?)(?:(\d+)\.?(\d*)|\.(\d+))(?:e([+-]?\d+))?$/i;

// --- fractions of whole numbers --------------------------------------------------------------------------

const tenTo = (n) => 10n ** BigInt(n);
const magnitude = (n) => (n < 0n ? -n : n);

// A printed number as { n, d }, its exact value n/d; null if it is none.
function readExact(text) {
  const found = NUMBER.exec(text);
  if (!found) return null;
  const [, sign, whole = "", fraction = "", lone = "", power = "0"] = found;
  const digits = BigInt(whole + fraction + lone) * (sign === "-" ? -1n : 1n);
  const exponent = Number(power) - fraction.length - lone.length;
  return exponent >= 0 ? { n: digits * tenTo(exponent), d: 1n } : { n: digits, d: tenTo(-exponent) };
}

// The double nearest to n/d, ties to even: a bit that says whether anything was cut off makes the rounding
// of more than 53 bits right. Written for sizes far from the ends of the range, which inputs are held to.
function toDouble({ n, d }) {
  if (n === 0n) return 0;
  const bits = (x) => x.toString(2).length;
  const shift = 60 - bits(magnitude(n)) + bits(d);
  const top = shift > 0 ? magnitude(n) << BigInt(shift) : magnitude(n);
  const bottom = shift < 0 ? d << BigInt(-shift) : d;
  const quotient = top / bottom;
  const value = Number(quotient * bottom === top ? quotient : quotient | 1n);
  return (n < 0n ? -value : value) * 2 ** -shift;
}

// The exact value of a double.
function ofDouble(x) {
  const bits = new DataView(new ArrayBuffer(8));
  bits.setFloat64(0, x);
  const word = bits.getBigUint64(0), power = Number((word >> 52n) & 2047n);
  const digits = (word & ((1n << 52n) - 1n)) | (power ? 1n << 52n : 0n);
  const n = word >> 63n ? -digits : digits, shift = (power || 1) - 1075;
  return shift >= 0 ? { n: n << BigInt(shift), d: 1n } : { n, d: 1n << BigInt(-shift) };
}

// The whole number nearest to n/d, n >= 0, a half up or down.
const halfUp = (n, d) => (2n * n + d) / (2n * d), halfDown = (n, d) => (2n * n + d - 1n) / (2n * d);

// n/d with so many decimals (fewer than none: rounded to tens), a half up; or to whole numbers otherwise.
function fixedExact({ n, d }, places, whole = halfUp) {
  return pointed(places < 0 ? whole(magnitude(n), d * tenTo(-places)) : whole(magnitude(n) * tenTo(places), d), places, n < 0n);
}

// A whole number of such decimals, or tens, as text.
function pointed(n, places, negative) {
  const behind = places < 0 ? 0 : places, text = String(n * tenTo(behind - places)).padStart(behind + 1, "0");
  return (negative ? "-" : "") + (behind ? `${text.slice(0, -behind)}.${text.slice(-behind)}` : text);
}

// --- digits of a double ----------------------------------------------------------------------------------

// The significant digits of a number, the fifteen that every double has or more, and the power of ten of the first; a half
// goes up.
function kept(x, digits = 15) {
  const [mantissa, power] = Math.abs(x).toExponential(Math.min(Math.max(14, digits - 1), 100)).split("e");
  return { all: mantissa.replace(".", ""), first: Number(power) };
}

// Rounded to so many of them (none: whether they are half of one more), as a whole number.
const head = (all, digits) => BigInt(all.slice(0, digits < 0 ? 0 : digits)) + BigInt(all[digits] >= "5");

// With so many decimals; fewer than none: rounded to tens. Where the next digit is no 5, no half is near.
function fixed(x, places) {
  if (places >= 0 && places < 100 && Math.abs(x) < 1e21 && !x.toFixed(places + 1).endsWith("5")) return x.toFixed(places);
  const { all, first } = kept(x, order(x) + 1 + places), digits = first + 1 + places;
  return pointed(head(all, digits) * tenTo(Math.max(digits - all.length, 0)), places, x < 0);
}

// The power of ten of the first digit of a number; 0 for zero.
const order = (x) => Number(x.toExponential().split("e")[1]);

// The significant digits of a number that is not zero, at most fifteen, and the power of ten of the first.
function significant(x, digits) {
  const { all, first } = kept(x), text = String(head(all, digits)); // one digit more where 9.95 became 10.0
  return { digits: text.slice(0, digits), first: first + text.length - digits };
}

// --- numbers as they are shown ---------------------------------------------------------------------------

function figureOf(text, exponent = null) {
  const plain = text.replace("-", ""), [whole, fraction = ""] = plain.split(".");
  return { negative: text[0] === "-" && /[1-9]/.test(plain), whole, fraction, exponent: exponent || null }; // a power of 0 is no power
}

// A printed number as it stands; null if it is not plain digits.
function readFigure(text) {
  const found = /^(-?)(\d+)(?:\.(\d+))?(?:e([+-]?\d+))?$/i.exec(text);
  if (!found) return null;
  const [, sign, whole, fraction = "", power] = found;
  return { negative: sign === "-", whole, fraction, exponent: power === undefined ? null : Number(power) };
}

// A number up to a digit, the power of ten of which is given. `scientific` null decides: where zeros before the point
// would pass for known digits, or more than three stand behind it.
function rounded(value, place, scientific = null) {
  const text = fixed(value, -place), all = text.replace(/^[-0.]+|\./g, "").slice(0, place > 0 ? -place : undefined);
  const first = all && place + all.length - 1, behind = order(value) - place;
  if (!(scientific ?? (all && (place > 0 || first < -3)))) return figureOf(text);
  const rest = behind > 0 ? `.${all.slice(1, behind + 1).padEnd(behind, "0")}` : "";
  return figureOf((value < 0 ? "-" : "") + (all[0] ?? 0) + rest, Number(first));
}

// An uncertainty as it is told: its digits, and the power of ten of the last. Rounded, halves of the six digits that are
// believed up; and up where rounding would make it smaller by more than a twentieth (JCGM 100, 7.2.6).
function told(u, most = 2) {
  const { digits, first } = significant(u, 6), short = Math.round(digits / 10 ** (6 - most));
  const text = String(short + (Number(`${short}e${first - most + 1}`) < 0.95 * u));
  return { digits: text.slice(0, most), place: first - 2 * most + 1 + text.length };
}

// The power of ten of the last digit that is shown of a number: that of its uncertainty, if that is known; of what is
// certain, without idle zeros; else the last of so many digits.
function lastPlace(value, u, digits, most) {
  if (u > 0 && u < Infinity) {
    return Math.min(Math.max(told(u, most).place, order(Math.max(Math.abs(value), u)) - 14), Math.max(order(value), Math.abs(value) > 1e-9 * u ? -Infinity : 0));
  }
  let place = order(value) - digits + 1;
  if (u === 0) {
    const short = value ? significant(value, digits) : { digits: "", first: -1 };
    place = Math.max(place, Math.min(0, short.first - short.digits.replace(/0+$/, "").length + 1));
  }
  return place > 0 && place <= 2 ? 0 : place;
}

// A value and its uncertainty: with the same decimals, and the same power of ten.
function stated(value, u, most) {
  const { digits, place } = told(u, most), own = lastPlace(value, u, 1, most), short = Number(`${digits}e${place}`);
  return place < own ? [rounded(value, own), rounded(short, place)] : alike([value, short], place, Math.max(Math.abs(value), u));
}

// Numbers up to the same digit, with the power of ten of the largest.
function alike(values, place, most) {
  const { exponent } = rounded(most, place);
  return values.map((x) => (exponent === null ? figureOf(fixed(x, -place)) : shifted(fixed(x, -place), place, exponent)));
}

// A text that ends at a place, with another power of ten.
function shifted(text, place, exponent) {
  const plain = text.replace(/[-.]/g, "").replace(/^0+/, ""), behind = exponent - place;
  const digits = plain.slice(0, place > 0 ? -place : undefined).padStart(behind + 1, "0"), point = digits.length - behind;
  return figureOf(`${text[0] === "-" ? "-" : ""}${digits.slice(0, point)}.${digits.slice(point)}`, exponent);
}

const decimals = (value, places) => figureOf(fixed(value, Math.max(0, places)));

// A column: a power of ten for all its numbers or for none. NaN has no figure.
function shownColumn(values, places) {
  const all = (scientific) => values.map((value, row) => (Number.isNaN(value) ? null : rounded(value, places(row), scientific)));
  const found = all();
  return found.some((figure) => figure && figure.exponent !== null) ? all(true) : found;
}

const raised = (n) => String(n).replace(/\d/g, (digit) => RAISED[digit]).replace("-", "⁻");

// For the eye: a real minus sign, thin spaces in long numbers, a written power of ten.
function figureText({ negative, whole, fraction, exponent }) {
  const grouped = whole.length >= 5 ? whole.replace(/\B(?=(?:\d{3})+$)/g, THIN) : whole;
  const power = exponent === null ? "" : `\u00a0×\u00a010${raised(exponent)}`;
  return `${negative ? MINUS : ""}${grouped}${fraction && `.${fraction}`}${power}`;
}

const signedText = (figure) => {
  const zero = !/[1-9]/.test(figure.whole + figure.fraction);
  return figure.negative || zero ? figureText(figure) : `+${figureText(figure)}`;
};

// Below which such a part of sorted numbers lies, between two of them in proportion.
function quantile(sorted, part) {
  const place = part * (sorted.length - 1), n = Math.floor(place);
  return sorted[n] + (place - n) * ((sorted[n + 1] ?? sorted[n]) - sorted[n]);
}

// All digits of a double, as the issued page writes them.
function repr(x) {
  if (!Number.isFinite(x)) return "";
  const [mantissa, power] = x.toExponential().split("e"), exponent = Number(power);
  if (exponent < -4 || exponent >= 16) {
    return `${mantissa}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
  }
  const plain = exponent < 0 ? x.toFixed(mantissa.replace(/[-.]/g, "").length - 1 - exponent) : String(x);
  return plain.includes(".") ? plain : `${plain}.0`;
}

// Six significant digits without idle zeros.
function brief(x) {
  if (x === 0) return "0";
  const { digits, first } = significant(x, 6), plain = digits.replace(/0+$/, ""), sign = x < 0 ? "-" : "";
  if (first < -4 || first >= 6) {
    const power = `${first < 0 ? "-" : "+"}${String(Math.abs(first)).padStart(2, "0")}`;
    return `${sign}${plain[0]}${plain.length > 1 ? `.${plain.slice(1)}` : ""}e${power}`;
  }
  if (first < 0) return `${sign}0.${"0".repeat(-first - 1)}${plain}`;
  const whole = plain.padEnd(first + 1, "0");
  return sign + whole.slice(0, first + 1) + (whole.length > first + 1 ? `.${whole.slice(first + 1)}` : "");
}

// --- beside a printed number -----------------------------------------------------------------------------

// Decimal places as printed: 3 for 2.940, -2 for 12e2.
function decimalsOf(text) {
  const [mantissa, power = "0"] = text.toLowerCase().split("e");
  return (mantissa.split(".")[1] ?? "").length - Number(power);
}

// A printed number with so many units of its last digit more; what is no number stays.
function stepped(text, by) {
  const concise = CONCISE.exec(text);
  if (concise) return `${stepped(concise[1], by)}(${concise[2]})`;
  if (!NUMBER.test(text)) return text;
  const [mantissa, ...power] = text.split(/(?=e)/i), places = decimalsOf(mantissa), d = tenTo(places);
  return fixedExact({ n: readExact(mantissa).n * d / readExact(mantissa).d + BigInt(by), d }, places) + power.join("");
}

// n/d in the 15 digits that every double keeps, so that 29.7 is not cut to 29.6.
function nearExact(x) {
  const value = toDouble(x);
  return Number.isFinite(value) ? readExact(value.toExponential(14)) : x;
}

// A double beside a printed number: printed as that is, how far off in units of its last digit, the same? Its unit is n/d
// in SI, its zero zero/d. A half may have gone either way; of fifteen printed digits and more, all of the double's count.
function beside(value, text, [n, d, zero = 0n], truncated) {
  const exact = ofDouble(value), places = decimalsOf(text), printed = readExact(text);
  const inUnit = { n: exact.n * d - zero * exact.d, d: exact.d * n }, near = truncated || text.replace(/^[-+.0]+|e.*|\D/gi, "").length < 15 ? nearExact(inUnit) : inUnit;
  const isPrinted = (again) => readExact(again).n === printed.n; // with as many decimals
  const ways = (truncated ? [(n, d) => n / d] : [halfUp, halfDown]).map((whole) => fixedExact(near, places, whole)), again = ways.find(isPrinted) ?? ways[0];
  const off = { n: inUnit.n * printed.d - printed.n * inUnit.d, d: inUnit.d * printed.d };
  const distance = places >= 0 ? { n: off.n * tenTo(places), d: off.d } : { n: off.n, d: off.d * tenTo(-places) };
  return { again, distance: toDouble(distance), same: isPrinted(again) };
}
