// The page's texts in the reader's language: the one chosen at the foot of the page, otherwise the browser's.
import { element } from "./element";
import { english } from "./texts/english";
import { french } from "./texts/french";
import { german } from "./texts/german";
import { japanese } from "./texts/japanese";

export type Texts = typeof english;

/** The daemon's own texts: reasons, refusals, the log. */
export const DAEMON_LANGUAGE = "en";

const LANGUAGES = new Map<string, { name: string; texts: Texts }>([
  ["en", { name: "English", texts: english }],
  ["de", { name: "Deutsch", texts: german }],
  ["fr", { name: "Français", texts: french }],
  ["ja", { name: "日本語", texts: japanese }],
]);
const CHOSEN = "language";
const JUST_CHOSEN = "a language was chosen"; // as the state of the history, which outlives a reload

function chosen_language(): string {
  try {
    return localStorage.getItem(CHOSEN) ?? "";
  } catch {
    return ""; // the browser lets no page store anything
  }
}

function language_of_reader(): string {
  const wanted = [chosen_language(), ...navigator.languages].map((tag) => tag.slice(0, 2).toLowerCase());
  return wanted.find((tag) => LANGUAGES.has(tag)) ?? "en";
}

export const language = language_of_reader();
export const texts = LANGUAGES.get(language)?.texts ?? english;

/** A text that takes no value, by its key. */
function plain_text(key: string): string {
  const text = (texts as Record<string, unknown>)[key];
  if (typeof text !== "string") throw new Error(`no text ${key}`);
  return text;
}

/** Puts the texts into index.html, where data-text and data-label (the aria-label) name their keys. */
export function fill_in_texts(): void {
  document.documentElement.lang = language;
  for (const node of document.querySelectorAll<HTMLElement>("[data-text]")) node.textContent = plain_text(node.dataset["text"] ?? "");
  for (const node of document.querySelectorAll<HTMLElement>("[data-label]")) node.setAttribute("aria-label", plain_text(node.dataset["label"] ?? ""));
}

/** Offers the languages in a select. The page is loaded again for another one, and the select keeps the focus. */
export function offer_languages(select: HTMLSelectElement): void {
  select.append(...Array.from(LANGUAGES, ([tag, { name }]) => element("option", { value: tag, lang: tag }, name)));
  select.value = language;
  select.addEventListener("change", () => {
    localStorage.setItem(CHOSEN, select.value);
    history.replaceState(JUST_CHOSEN, "");
    location.reload();
  });
  if (history.state === JUST_CHOSEN) select.focus();
  history.replaceState(null, "");
}
