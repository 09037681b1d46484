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

// A duration in seconds: to the second, from an hour on to the minute.
export function duration(seconds) {
  const whole = Math.floor(seconds), minutes = Math.floor(whole / 60);
  if (whole < 60) return `${whole} s`;
  if (whole < 3600) return whole % 60 ? `${minutes} min ${whole % 60} s` : `${minutes} min`;
  return minutes % 60 ? `${Math.floor(minutes / 60)} h ${minutes % 60} min` : `${minutes / 60} h`;
}

// An estimated duration to the digits that it deserves.
export function rounded(seconds) {
  const [, step] = [[10, 1], [30, 5], [90, 10], [2700, 60], [Infinity, 600]].find(([most]) => seconds < most);
  return Math.max(step * Math.floor(seconds / step + 0.5), 1);
}

// An estimate with its range, each in seconds: about 3 min (2 to 5 min).
export function timeLeft({ seconds, lower, upper }) {
  const [low, about, high] = [lower, seconds, upper].map((value) => duration(rounded(value)));
  return low === high ? `about ${about}` : `about ${about} (${low} to ${high})`;
}
