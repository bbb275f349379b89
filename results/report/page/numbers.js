// Unpacks the numbers of the page's data (results/report/page_numbers.hpp).

function bytesOf(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64); // of newer browsers, and faster
  const binary = atob(base64);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflated(base64) {
  const stream = new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Undoes the shuffle: bytes b of all elements lie together; an element has `size` bytes.
function unshuffled(bytes, size) {
  const count = bytes.length / size;
  const elements = new Uint8Array(bytes.length);
  for (let b = 0; b < size; ++b) {
    for (let i = 0, from = b * count; i < count; ++i) elements[i * size + b] = bytes[from + i];
  }
  return elements.buffer;
}

export async function unpackNumbers(base64) {
  return new Float64Array(unshuffled(await inflated(base64), 8));
}

// Levels along lines of `size` numbers, `stride` apart: undoes the second differences. Level 0 is missing (NaN),
// level 1 + n is low + n step; on a logarithmic scale level 1 is zero, level 2 + n is low exp(n step).
export async function unpackLevels({ levels, scale, low, step }, { size, stride }) {
  const bytes = await inflated(levels),
    count = bytes.length / 4;
  const whole = new Int32Array(count);
  const block = size * stride; // lines side by side
  for (let from = 0; from < count; from += block) {
    for (let i = from; i < from + block; ++i) {
      const code =
        bytes[i] + 256 * (bytes[i + count] + 256 * (bytes[i + 2 * count] + 256 * bytes[i + 3 * count]));
      const before = i - stride >= from ? whole[i - stride] : 0;
      const beforeThat = i - 2 * stride >= from ? whole[i - 2 * stride] : 0;
      whole[i] = (code % 2 ? -((code + 1) / 2) : code / 2) + 2 * before - beforeThat;
    }
  }
  return scale === "log" ? onLogScale(whole, low, step) : onLinearScale(whole, low, step);
}

function onLinearScale(levels, low, step) {
  const values = new Float64Array(levels.length);
  for (let i = 0; i < levels.length; ++i) values[i] = levels[i] === 0 ? NaN : low + (levels[i] - 1) * step;
  return values;
}

function onLogScale(levels, low, step) {
  const values = new Float64Array(levels.length);
  for (let i = 0; i < levels.length; ++i) {
    values[i] = levels[i] === 0 ? NaN : levels[i] === 1 ? 0 : low * Math.exp((levels[i] - 2) * step);
  }
  return values;
}
