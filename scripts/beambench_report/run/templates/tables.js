"use strict";

// Tables are sorted and filtered by DataTables (https://datatables.net), which scripts/viewer fetches.
// Without DataTables or JavaScript, tables are shown as they were written.

/** Escapes labels and search data, both of which DataTables takes for HTML. */
const escaped = (text) => DataTable.util.escapeHtml(text);

/** The filter of one column: figures are compared; if there are only a few texts, the reader chooses among them. */
const columnFilters = (isFigure, texts) => {
  const options = () => texts.map((text) => ({ label: escaped(text) || "(none)", value: text }));
  let own = "searchText";
  if (isFigure) own = { extend: "searchNumber", excludeLogic: ["empty", "notEmpty"] };
  else if (texts.length <= 100) own = { extend: "searchList", options: options() };
  return [{ extend: "dropdown", icon: "search", iconActive: "searchActive", text: "Filter", content: [own] }];
};

const makeTable = (table, options = {}) =>
  new DataTable(table, {
    autoWidth: false, order: [], paging: false, searching: false, info: false,
    layout: { topStart: null, topEnd: null, bottomStart: null, bottomEnd: null },
    language: {
      info: "Rows _START_ to _END_ of _TOTAL_", infoEmpty: "No row matches", infoFiltered: "(of _MAX_ in all)",
      lengthMenu: "_MENU_ rows", search: "Filter", thousands: ",", zeroRecords: "No row matches", emptyTable: "No rows",
    },
    ...options,
  });

// Fields that were not measured stay last in both directions.
if (window.DataTable) {
  const nothingLast = (sign) => (a, b) => (a === "" || b === "" ? (a === "") - (b === "") : sign * (a - b));
  DataTable.type("num-last", { order: { asc: nothingLast(1), desc: nothingLast(-1) } });
}

/** Makes a table of class `sortable`; with `data-filter`, an example of words, the table also has filters. */
const makeSortable = (table) => {
  const rows = [...table.tBodies[0].rows];
  const example = table.dataset.filter;
  const columnDefs = [...table.tHead.rows[0].cells].map((head, targets) => {
    if (head.dataset.orderable === "false") return { targets, searchable: false };
    const cells = rows.map((row) => row.cells[targets]);
    const orders = cells.map((cell) => cell.dataset.order).filter((order) => order !== undefined);
    const isFigure = orders.length > 0 && !orders.some((order) => Number.isNaN(Number(order)));
    const type = isFigure ? { type: "num-last" } : {};
    if (orders.length > 0) for (const cell of cells) cell.dataset.order ??= "";
    if (example === undefined) return { targets, ...type };
    const texts = cells.map((cell) => cell.textContent.trim().replace(/\s+/g, " "));
    cells.forEach((cell, row) => (cell.dataset.search = escaped((isFigure && cell.dataset.order) || texts[row])));
    return { targets, ...type, columnControl: columnFilters(isFigure, [...new Set(texts)].sort()) };
  });
  const search = { search: { placeholder: example } };
  return makeTable(table, example === undefined ? { columnDefs } : {
    columnDefs, searching: true, info: true, layout: { topStart: search, topEnd: "info", bottomStart: null, bottomEnd: null },
  });
};

/** Calls `make` when the element is about to be seen: a page may have hundreds of tables. */
const whenSeen = (element, make) => {
  const observer = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    observer.disconnect();
    make(element);
  }, { rootMargin: "50%" });
  observer.observe(element);
};
if (window.DataTable) for (const table of document.querySelectorAll("table.sortable")) whenSeen(table, makeSortable);

// On paper nothing can be opened.
(() => {
  const opened = [];
  addEventListener("beforeprint", () => {
    for (const details of document.querySelectorAll("details:not([open])")) {
      details.open = true;
      opened.push(details);
    }
  });
  addEventListener("afterprint", () => {
    for (const details of opened.splice(0)) details.open = false;
  });
})();
