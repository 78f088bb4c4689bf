// Numbers as people read them, and the ticks of axes.

// Three or four digits; powers of ten where they are far from 1.
export function written(x, digits = 3) {
  if (x === 0 || !Number.isFinite(x)) return String(x);
  const size = Math.abs(x);
  if (size >= 1e5 || size < 1e-3) {
    const [mantissa, exponent] = x.toExponential(digits - 1).split("e");
    const power = `10${raised(Number(exponent))}`;
    const factor = trimmed(mantissa);
    return factor === "1" ? power : `${factor}·${power}`.replace("-", "−");
  }
  return trimmed(x.toPrecision(digits + (size >= 1000 ? 1 : 0))).replace("-", "−");
}

function trimmed(text) {
  if (text.includes("e")) return String(Number(text));
  return text.includes(".") ? text.replace(/\.?0+$/, "") : text;
}

export function raised(exponent) {
  return String(exponent).replace(/[-0-9]/g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]));
}

// Round places between low and high, about as many as wanted.
export function ticks(low, high, wanted = 5) {
  const span = high - low;
  if (!(span > 0) || !Number.isFinite(span)) return [low];
  const rough = span / wanted;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((s) => s * power >= rough * 0.999);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => (first + i) * step);
}

// Powers of ten between low and high, at most as many as wanted; 1, 2, 5 times such if there are
// fewer than two.
export function decades(low, high, wanted = 6) {
  const first = Math.ceil(Math.log10(low) - 1e-9);
  const last = Math.floor(Math.log10(high) + 1e-9);
  const stride = Math.max(1, Math.ceil((last - first + 1) / wanted));
  const found = [];
  if (last - first < 1) {
    for (let e = first - 1; e <= last + 1; e++) found.push(...[1, 2, 5].map((s) => s * 10 ** e));
    return found.filter((x) => x >= low && x <= high);
  }
  for (let e = first; e <= last; e += stride) found.push(10 ** e);
  return found;
}

// The unit of powers of a length: "mm²", or "length²" where no unit is known.
export function unitOf(name, power) {
  const base = name || "length";
  return power === 1 ? base : power > 0 ? base + raised(power) : `1/${unitOf(name, -power)}`;
}
