// How far to both sides 95 % of an error are: of a t distribution, and of a sum of errors of several kinds.
// Nothing in this file knows the page; what finds the only root of a column finds these.

const sum = (numbers) => numbers.reduce((all, one) => all + one, 0);

const NORMAL = 1.959963984540054;
// Of errors that end: where, in standard uncertainties; and what a wave comes to on an average over them, by its phase there.
const ENDED = {
  rectangular: [Math.sqrt(3), (phase) => Math.sin(phase) / phase], triangular: [Math.sqrt(6), (phase) => (Math.sin(phase / 2) / (phase / 2)) ** 2],
  arcsine: [Math.SQRT2, bessel],
};
const DOMINANT = 0.3; // of one error all others together are so little beside it (EA-4/02, S9.14)
const WAVES = 8000; // at most
const LITTLE = 1e-10; // of an average
const WRAPPED = 3e-6; // of a t distribution may be taken for what is within

// Half of what holds 95 % of a sum of independent errors, in standard uncertainties. What is within x is a Fourier series whose
// period holds nearly all of the sum, and an average over a sum of errors is the product of theirs.
function summedFactor(errors) {
  const ends = ({ shape, dof, size }) => size * (ENDED[shape]?.[0] ?? 6 + (dof ? studentFactor(dof) * (0.05 / WRAPPED) ** (1 / (dof + 1)) : 0));
  const moving = errors.filter(({ size }) => size > 0), reach = sum(moving.map(ends)), waves = [];
  const averages = moving.map((error) => averageOver(error, ends(error)));
  for (let n = 1, still = 0; n <= WAVES && still < 3; n++) {
    const average = averages.reduce((all, of) => all * of(n * Math.PI / reach), 1);
    still = Math.abs(average) < LITTLE ? still + 1 : 0;
    waves.push(2 * average / (n * Math.PI));
  }
  const within = (x) => x / reach + sum(waves.map((wave, n) => wave * Math.sin((n + 1) * Math.PI * x / reach)));
  return bisect({ at: (_, x) => within(x) - 0.95 }, 0, 0, reach, 1);
}

// The average of cos(frequency * error), of one that has ends, is normal, or t: normal with a variance that nobody knows.
function averageOver({ shape, dof, size }, end) {
  if (ENDED[shape]) return (frequency) => ENDED[shape][1](frequency * end);
  if (!dof) return (frequency) => Math.exp(-((frequency * size) ** 2) / 2);
  const low = -40 / dof - 1, high = Math.log(4 + 60 / dof), variances = [], weights = [];
  for (let z = low; z < high; z += (high - low) / 200) {
    variances.push(size ** 2 / Math.exp(z));
    weights.push(Math.exp(dof / 2 * (z + 1 - Math.exp(z))));
  }
  const all = sum(weights);
  return (frequency) => sum(weights.map((weight, n) => weight * Math.exp(-(frequency ** 2) * variances[n] / 2))) / all;
}

// J_0; from where its asymptotic expansion is as good, by that.
function bessel(x) {
  if (x < 200) return mean(Math.ceil(40 + x), (part) => Math.cos(x * Math.sin(part * Math.PI)));
  return Math.sqrt(2 / Math.PI / x) * (Math.cos(x - Math.PI / 4) + Math.sin(x - Math.PI / 4) / (8 * x));
}

const mean = (number, of) => sum(Array.from({ length: number }, (_, n) => of((n + 0.5) / number))) / number;

// Half of what holds 95 % of a t distribution: with t = sqrt(freedom) tan(angle) it is an integral of a power of the cosine.
function studentFactor(freedom) {
  if (Number.isNaN(freedom)) return NaN;
  if (freedom > 1000) return NORMAL * (1 + (NORMAL ** 2 + 1) / (4 * freedom));
  const upTo = (angle) => {
    let n = (freedom - 1) % 2, all = n ? Math.sin(angle) : angle;
    for (n += 2; n < freedom; n += 2) all = (Math.cos(angle) ** (n - 1) * Math.sin(angle) + (n - 1) * all) / n;
    return all;
  };
  const wanted = 0.95 * upTo(Math.PI / 2);
  return Math.sqrt(freedom) * Math.tan(bisect({ at: (_, angle) => upTo(angle) - wanted }, 0, 0, Math.PI / 2, 1));
}
