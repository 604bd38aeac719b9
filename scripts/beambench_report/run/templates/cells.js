// The table of all cells: sorts, filters and pages through the packed rows, which may be hundreds of
// thousands, and keeps only the page that is shown in the document.
(() => {
  const { rows, columns } = JSON.parse(document.getElementById("cells-data").textContent);
  const section = document.getElementById("cells");
  const table = document.getElementById("cells-table");
  const form = section.querySelector("form");
  const previous = section.querySelector("[name=previous]");
  const next = section.querySelector("[name=next]");
  const texts = columns.filter((column) => column.words);
  const byName = new Map(columns.map((column) => [column.name, column]));
  const plain = new Intl.NumberFormat("en", { maximumSignificantDigits: 5 });
  const whole = new Intl.NumberFormat("en");

  let matching = Uint32Array.from({ length: rows }, (_, row) => row);
  let sorted = null; // { name, descending }
  let page = 0;

  const isShown = (column) => column.first || column.group === "" || groups().has(column.group);
  const groups = () =>
    new Set([...form.querySelectorAll("[name=group]:checked")].map((box) => box.value));

  const textOf = (column, row) => {
    if (column.words) return column.words[column.at[row]];
    const figure = column.figures[row];
    if (figure === null) return "–";
    return (Number.isInteger(figure) ? whole : plain).format(figure);
  };

  // Filtering

  const comparison = (word) => {
    const [, name, sign, text] = /^([a-z_]+)([<>=])(.+)$/.exec(word) ?? [];
    const figures = byName.get(name)?.figures;
    const bound = Number(text);
    if (!figures || Number.isNaN(bound)) return null;
    const holds = { "<": (a) => a < bound, ">": (a) => a > bound, "=": (a) => a === bound }[sign];
    return (row) => figures[row] !== null && holds(figures[row]);
  };

  // A text that many rows share is searched once.
  const occurrence = (word) => {
    const found = texts.map(({ words, at }) => ({
      at,
      has: words.map((text) => text.toLowerCase().includes(word)),
    }));
    return (row) => found.some(({ at, has }) => has[at[row]]);
  };

  const notRight = (row) => !["ok", "baseline"].includes(textOf(byName.get("verdict"), row));

  const filter = () => {
    const words = form.elements.filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const tests = words.map((word) => comparison(word) ?? occurrence(word));
    if (form.elements.wrong.checked) tests.push(notRight);
    const kept = [];
    for (let row = 0; row < rows; ++row) if (tests.every((test) => test(row))) kept.push(row);
    matching = Uint32Array.from(kept);
    sort();
  };

  // Sorting

  const keysOf = (column) => {
    if (column.figures) return column.figures;
    const order = column.words.map((_, place) => place);
    order.sort((a, b) => column.words[a].localeCompare(column.words[b], "en", { numeric: true }));
    const ranks = [];
    order.forEach((place, rank) => (ranks[place] = rank));
    return column.at.map((place) => ranks[place]);
  };

  const sort = () => {
    page = 0;
    if (sorted) {
      const keys = keysOf(byName.get(sorted.name));
      const sign = sorted.descending ? -1 : 1;
      matching.sort((a, b) => {
        const [x, y] = [keys[a], keys[b]];
        if (x === null || y === null) return (x === null) - (y === null) || a - b;
        return sign * (x - y) || a - b;
      });
    }
    show();
  };

  const sortBy = (name) => {
    sorted = { name, descending: sorted?.name === name && !sorted.descending };
    sort();
  };

  // Showing

  const makeHead = () => {
    const line = document.createElement("tr");
    for (const column of columns.filter(isShown)) {
      const head = document.createElement("th");
      head.scope = "col";
      head.title = column.unit ? `${column.meaning} (${column.unit})` : column.meaning;
      if (column.figures) head.className = "figure";
      if (sorted?.name === column.name)
        head.setAttribute("aria-sort", sorted.descending ? "descending" : "ascending");
      const button = document.createElement("button");
      button.type = "button";
      column.name.split(/(?<=_)/).forEach((part) => button.append(part, document.createElement("wbr")));
      button.addEventListener("click", () => {
        sortBy(column.name);
        table.querySelector("[aria-sort] button")?.focus(); // the old button is gone
      });
      head.append(button);
      line.append(head);
    }
    table.tHead.replaceChildren(line);
  };

  const makeRow = (row) => {
    const line = document.createElement("tr");
    for (const column of columns.filter(isShown)) {
      const cell = document.createElement("td");
      cell.textContent = textOf(column, row);
      if (column.figures) cell.className = "figure";
      if (column.name === "verdict") {
        const pill = document.createElement("span");
        pill.className = `pill ${notRight(row) ? "wrong" : cell.textContent}`;
        pill.textContent = cell.textContent || "no verdict";
        cell.replaceChildren(pill);
      }
      line.append(cell);
    }
    return line;
  };

  const show = () => {
    const size = Number(form.elements["page-size"].value);
    const begin = page * size;
    const end = Math.min(begin + size, matching.length);
    makeHead();
    table.tBodies[0].replaceChildren(...Array.from(matching.subarray(begin, end), makeRow));
    previous.disabled = page === 0;
    next.disabled = end === matching.length;
    const kept = matching.length === rows ? "" : `, of ${whole.format(rows)} in all`;
    document.getElementById("cells-count").textContent =
      matching.length === 0
        ? "No row has all of that"
        : `Rows ${whole.format(begin + 1)} to ${whole.format(end)} of ${whole.format(matching.length)}${kept}`;
  };

  const turn = (step) => {
    page += step;
    show();
  };

  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("input", (event) => {
    if (["filter", "wrong"].includes(event.target.name)) return filter();
    if (event.target.name === "page-size") page = 0;
    show();
  });
  previous.addEventListener("click", () => turn(-1));
  next.addEventListener("click", () => turn(1));
  for (const control of section.querySelectorAll(".controls")) control.hidden = false;
  show();
})();
