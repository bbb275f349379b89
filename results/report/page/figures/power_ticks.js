// The ticks of a logarithmic axis.
import { numberText, superscript } from "../units.js";

// The ticks of a logarithmic axis: powers of ten, or 1, 2, 5 of each where there are few.
export function powerTicks([low, high]) {
  const decades = Math.log10(high / low),
    step = Math.ceil(decades / 8);
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power) {
    if (power % step !== 0) continue;
    for (const digit of decades < 2 ? [1, 2, 5] : [1]) ticks.push(digit * 10 ** power);
  }
  return ticks.filter((tick) => tick >= low && tick <= high);
}

// The tick format of a logarithmic axis over this domain: plain, or powers of ten if plain takes many zeros.
export function powerText([low, high]) {
  if (low >= 1e-3 && high < 1e5) return (value) => numberText(value);
  return (value) => {
    const power = Math.round(Math.log10(value)),
      digit = Math.round((value / 10 ** power) * 10) / 10;
    const ten = power === 0 ? "1" : `10${superscript(power)}`;
    return digit === 1 ? ten : numberText(value, 1);
  };
}
