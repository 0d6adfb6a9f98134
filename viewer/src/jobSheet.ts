/** What the run was asked for. */
import { escapeHtml } from './format';
import type { RunReport } from './types';

/** Settings one by one, as "tow.width" and "8"; things in lists are numbered from 1. */
function settingsOf(value: unknown, path: string): [string, string][] {
    const isThing = (v: unknown): v is object => typeof v === 'object' && v !== null;
    const below = (key: string): string => (path ? `${path}.${key}` : key);
    if (Array.isArray(value)) {
        return value.some(isThing)
            ? value.flatMap((v, i) => settingsOf(v, below(String(i + 1))))
            : [[path, value.join(', ')]];
    }
    if (isThing(value)) return Object.entries(value).flatMap(([key, v]) => settingsOf(v, below(key)));
    return [[path, String(value)]];
}

export function jobHtml({ job, seed, effort }: RunReport): string {
    const search = Object.entries({ seed, effort }).filter(([, v]) => v !== undefined);
    const rows = [...settingsOf(job ?? {}, ''), ...search].map(
        ([key, value]) =>
            `<tr><th scope="row">${escapeHtml(String(key))}</th><td>${escapeHtml(String(value))}</td></tr>`,
    );
    return (
        '<p class="muted sum">The settings that differ from the defaults.</p>' +
        `<table class="grid settings"><tbody>${rows.join('')}</tbody></table>`
    );
}
