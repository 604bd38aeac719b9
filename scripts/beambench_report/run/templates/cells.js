// The table of all cells: every column of the packed rows, a page at a time; it replaces the written table.
(() => {
  const { rows, columns } = JSON.parse(document.getElementById("cells-data").textContent);
  const section = document.getElementById("cells");
  const byName = new Map(columns.map((column) => [column.name, column]));
  const plain = new Intl.NumberFormat("en", { maximumSignificantDigits: 5 });
  const whole = new Intl.NumberFormat("en");

  const valueOf = (column, row) => (column.words ? column.words[column.at[row]] : column.figures[row] ?? "");
  const textOf = (column, row) => {
    const value = valueOf(column, row);
    if (column.words) return value;
    return value === "" ? "–" : (Number.isInteger(value) ? whole : plain).format(value);
  };
  const anchorOf = (row) =>
    `cell-${["view", "resolution", "contender"].map((name) => textOf(byName.get(name), row)).join(" ")}`
      .toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/-$/, "");

  const displayOf = (column, row) => {
    const text = textOf(column, row);
    if (!["contender", "verdict"].includes(column.name)) return escaped(text);
    const cell = document.createElement(column.name === "verdict" ? "span" : "a");
    cell.textContent = text || "no verdict";
    if (column.name === "contender") cell.href = `#${anchorOf(row)}`;
    else cell.className = `pill ${["ok", "baseline"].includes(text) ? text : "wrong"}`;
    return cell;
  };

  const definition = (column) => ({
    name: column.name,
    title: escaped(column.name).replaceAll("_", "_<wbr>"),
    ariaTitle: column.name,
    visible: column.first || column.group === "",
    type: column.figures ? "num-last" : "string",
    className: column.figures ? "figure" : "",
    columnControl: columnFilters(Boolean(column.figures), column.words),
    data: ([row], kind) => {
      if (kind === "display") return displayOf(column, row);
      const value = valueOf(column, row);
      return kind === "filter" ? escaped(column.figures && value === "" ? "–" : String(value)) : value;
    },
  });

  const makeCells = () => {
    const table = document.getElementById("cells-table");
    const heads = document.createElement("tr");
    heads.append(...columns.map(() => Object.assign(document.createElement("th"), { scope: "col" })));
    table.tHead.replaceChildren(heads);
    table.tBodies[0].replaceChildren();
    const api = makeTable(table, {
      columns: columns.map(definition),
      data: Array.from({ length: rows }, (_, row) => [row]),
      paging: true, searching: true, info: true, pageLength: 25, lengthMenu: [25, 100, 500],
      layout: {
        top2Start: { search: { placeholder: "samet 320x200" } }, top2End: "pageLength",
        topStart: "info", topEnd: { paging: { type: "simple" } }, bottomStart: null, bottomEnd: null,
      },
    });
    api.columns().every(function () {
      const { meaning, unit } = columns[this.index()];
      this.header().title = unit ? `${meaning} (${unit})` : meaning;
    });
    const groups = section.querySelector("form.groups");
    groups.hidden = false;
    groups.addEventListener("submit", (event) => event.preventDefault());
    groups.addEventListener("input", ({ target }) => {
      const own = columns.flatMap((column, place) => (column.group === target.value && !column.first ? [place] : []));
      api.columns(own).visible(target.checked);
    });
    // The filter is kept in the address, for links and reloads.
    api.on("search", () => {
      const asked = api.search().trim();
      const place = asked ? `#filter=${encodeURIComponent(asked)}` : "";
      if (place || location.hash.startsWith("#filter=")) history.replaceState(null, "", place || "#cells");
    });
    return api;
  };
  let made = null;
  const cells = () => (made ??= makeCells());
  if (window.DataTable) whenSeen(document.getElementById("cells-table"), cells);

  /** Opens what the address names: a filter, or one cell. */
  const open = () => {
    const wanted = decodeURIComponent(location.hash.slice(1));
    if (wanted.startsWith("filter=") && window.DataTable && cells().search() !== wanted.slice(7)) {
      cells().search(wanted.slice(7)).draw();
    }
    const box = document.getElementById("one-cell");
    box.hidden = !wanted.startsWith("cell-");
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
      // The unit of a string describes its format, such as "16 hex digits".
      const unit = column.figures ? column.unit.replace("10^6 ", "million ") : "";
      value.textContent = unit ? `${text} ${unit}` : text;
      pair.append(name, value);
      list.append(pair);
    }
    box.append(title, list);
    box.scrollIntoView();
  };
  addEventListener("hashchange", open);
  open();
})();
