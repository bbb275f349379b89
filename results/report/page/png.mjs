// A PNG picture as a data URL, in Node.js.
import { encode } from "fast-png";

// rgba: 4 bytes a pixel, row by row from the top.
export function pngImage(width, height, rgba) {
  const png = encode({ width, height, data: rgba, channels: 4, depth: 8 });
  return `data:image/png;base64,${Buffer.from(png).toString("base64")}`;
}
