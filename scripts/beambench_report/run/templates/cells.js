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

  const holds = {
    "<": (a, b) => a < b, ">": (a, b) => a > b, "<=": (a, b) => a <= b, ">=": (a, b) => a >= b,
    "=": (a, b) => a === b, "!=": (a, b) => a !== b,
  };

  // A test of rows, or a sentence on what is wrong with the word; null where it is no comparison.
  const comparison = (word) => {
    const [, name, sign, text] = /^([a-z_0-9]+)(<=|>=|!=|<|>|=)(.*)$/.exec(word) ?? [];
    if (!name) return null;
    const column = byName.get(name);
    if (!column) return occurs(word) ? null : `'${word}': there is no column '${name}'`;
    if (column.words) {
      if (sign !== "=" && sign !== "!=") return `'${word}': ${name} holds texts, which only '=' and '!=' compare`;
      const same = column.words.map((one) => one.toLowerCase() === text);
      if (!same.includes(true)) return `'${word}': no row has this ${name}`;
      return (row) => same[column.at[row]] === (sign === "=");
    }
    const bound = Number(text);
    if (text === "" || Number.isNaN(bound)) return `'${word}': '${text}' is not a number`;
    return (row) => column.figures[row] !== null && holds[sign](column.figures[row], bound);
  };

  const occurs = (word) =>
    texts.some(({ words }) => words.some((text) => text.toLowerCase().includes(word)));

  // A text that many rows share is searched once.
  const occurrence = (word) => {
    const found = texts.map(({ words, at }) => ({
      at,
      has: words.map((text) => text.toLowerCase().includes(word)),
    }));
    return (row) => found.some(({ at, has }) => has[at[row]]);
  };

  const notRight = (row) => !["ok", "baseline"].includes(textOf(byName.get("verdict"), row));

  // A word with a minus before it leaves rows out.
  const test = (word) => {
    if (!/^-[^-]/.test(word)) return comparison(word) ?? occurrence(word);
    const wanted = test(word.slice(1));
    return typeof wanted === "string" ? wanted : (row) => !wanted(row);
  };

  const filter = () => {
    const asked = form.elements.filter.value;
    const words = asked.toLowerCase().replace(/\s*(<=|>=|!=|<|>|=)\s*/g, "$1").split(/\s+/).filter(Boolean);
    const understood = words.map(test);
    const tests = understood.filter((test) => typeof test !== "string");
    const problems = understood.filter((test) => typeof test === "string");
    const problem = document.getElementById("filter-problem");
    problem.hidden = problems.length === 0;
    problem.textContent = problems.length ? `Left out of the filter: ${problems.join("; ")}.` : "";
    if (form.elements.wrong.checked) tests.push(notRight);
    const kept = [];
    for (let row = 0; row < rows; ++row) if (tests.every((test) => test(row))) kept.push(row);
    matching = Uint32Array.from(kept);
    sort();
    // In the address, so that a link or a reload keeps it.
    const place = asked.trim() ? `#filter=${encodeURIComponent(asked.trim())}` : "";
    if (place || location.hash.startsWith("#filter=")) history.replaceState(null, "", place || "#cells");
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
      if (column.name === "contender") {
        const link = document.createElement("a");
        link.href = `#${anchorOf(row)}`;
        link.textContent = cell.textContent;
        cell.replaceChildren(link);
      }
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

  // One cell, opened by its link

  const anchorOf = (row) =>
    `cell-${["view", "resolution", "contender"].map((name) => textOf(byName.get(name), row)).join(" ")}`
      .toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/-$/, "");

  const open = () => {
    const wanted = decodeURIComponent(location.hash.slice(1));
    const box = document.getElementById("one-cell");
    box.hidden = !wanted.startsWith("cell-");
    if (wanted.startsWith("filter=") && form.elements.filter.value !== wanted.slice(7)) {
      form.elements.filter.value = wanted.slice(7);
      filter();
    }
    if (box.hidden) return;
    let row = 0;
    while (row < rows && anchorOf(row) !== wanted) ++row;
    box.replaceChildren();
    const title = document.createElement("h3");
    const list = document.createElement("dl");
    title.textContent = row === rows ? `This run has no cell '${wanted}'`
      : ["contender", "view", "resolution"].map((name) => textOf(byName.get(name), row)).join(", ");
    for (const column of row === rows ? [] : columns) {
      const text = textOf(column, row);
      if (text === "–" || text === "") continue;
      const pair = document.createElement("div");
      const name = document.createElement("dt");
      const value = document.createElement("dd");
      name.title = column.meaning;
      name.textContent = column.name.replaceAll("_", " ");
      // The unit of a text says how it is written, such as "16 hex digits".
      const unit = column.figures ? column.unit.replace("10^6 ", "million ") : "";
      value.textContent = unit ? `${text} ${unit}` : text;
      pair.append(name, value);
      list.append(pair);
    }
    box.append(title, list);
    box.scrollIntoView();
  };
  addEventListener("hashchange", open);

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
  open();
})();
