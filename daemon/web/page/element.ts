// Elements of the page. Text from outside (names, reasons) only ever becomes text.

type Child = Node | string;

/** An element with attributes and children; a text becomes a text node. */
export function element<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Record<string, string> = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

export function svg(tag: string, attributes: Record<string, string | number> = {}, ...children: Child[]): SVGElement {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  made.append(...children);
  return made;
}

/** The element of index.html. */
export function by_id(id: string): HTMLElement {
  const found = document.getElementById(id);
  if (found === null) throw new Error(`index.html has no ${id}`);
  return found;
}

/** Sets a text if it differs, to avoid needless layout and announcements. */
export function set_text(node: Node, text: string): void {
  if (node.textContent !== text) node.textContent = text;
}

/** Sets a text and its language. */
export function set_text_in(lang: string, node: HTMLElement, text: string): void {
  node.lang = lang;
  set_text(node, text);
}

/** Elements that stand for items of a list, kept as long as there are as many with the same names. */
export class Rows<Row> {
  private names = "";
  private rows: Row[] = [];

  constructor(
    private readonly list: HTMLElement,
    private readonly make: (name: string) => { item: HTMLElement; row: Row },
    private readonly when_empty: string,
  ) {}

  /** One for each name, in this order. */
  for_names(names: string[]): Row[] {
    const wanted = JSON.stringify(names);
    if (wanted !== this.names) {
      this.names = wanted;
      const made = names.map((name) => this.make(name));
      this.rows = made.map(({ row }) => row);
      const items = made.map(({ item }) => item);
      this.list.replaceChildren(...(items.length > 0 ? items : [element("li", { class: "empty" }, this.when_empty)]));
    }
    return this.rows;
  }
}
