// The page: unpacks the result it carries and shows what it is.
import { unpackRecord } from "./record.js";
import { element } from "./parts/elements.js";
import { provenanceSection } from "./parts/provenance.js";
import { heading } from "./parts/heading.js";
import { partsOf } from "./pages/pages.js";

async function show() {
  const page = document.getElementById("page");
  try {
    const record = await unpackRecord(JSON.parse(document.getElementById("data").textContent));
    page.replaceChildren(heading(record), ...partsOf(record), provenanceSection(record));
    document.body.dataset.state = "ready";
  } catch (error) {
    page.replaceChildren(
      element("p", { class: "failure" }, `This page could not be shown: ${error.message}`),
    );
    document.body.dataset.state = "failed";
    throw error;
  }
}

show();
