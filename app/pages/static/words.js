// Numbers in words, as ident/words has them for everything that the service writes itself.

const TIMES = 9.995; // from here on a fraction is so many times: never a per cent of four digits
const UNSTABLE = 1e3; // the error, eq. (17), from which on a model counts as unstable on a run

// A fraction in per cent to three digits.
export function percent(fraction) {
  if (Math.abs(fraction) >= TIMES) return `${Number(fraction.toPrecision(3))} times`;
  return `${(100 * fraction).toPrecision(3)} %`;
}

// An error of eq. (17).
export function errorWords(error) {
  return error < UNSTABLE ? percent(error) : "unstable";
}
