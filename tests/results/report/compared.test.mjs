// What a study compares a quantity with, on its page.
import assert from "node:assert/strict";
import { test } from "node:test";
import { circumstance, comparedWith } from "../../../results/report/page/compared.js";
import { ResponseMap } from "../../../results/report/page/record.js";

const peak = { name: "machine_peak", long_name: "peak of machine" };
const compared = { name: "machine_peak_compared", long_name: "peak of machine, as the frequency falls" };
const other = { name: "machine_rms", long_name: "rms of machine" };

test("a quantity is drawn with what it is compared with, and says under which circumstance", () => {
  const map = new ResponseMap([], [peak, compared, other], { parameters: [], left_out: [] });
  assert.equal(comparedWith(map, peak), compared);
  assert.equal(comparedWith(map, other), undefined);
  assert.equal(circumstance(compared, peak), "as the frequency falls");
});

test("where the long names do not say it, the compared quantity goes by its name", () => {
  assert.equal(circumstance({ name: "main_peak_compared" }, { name: "main_peak" }), "main peak compared");
});
