/** The checks of the report: values beside limits, words where one failed, a way to the place. */
import { escapeHtml, keyInWords, percent, sentence, valueInWords } from './format';
import type { Check, CheckKind, Measure, Place, Report } from './types';

const kTarget =
    '<svg viewBox="0 0 16 16" width="14" height="14" fill="none" stroke="currentColor" stroke-width="1.4" aria-hidden="true">' +
    '<circle cx="8" cy="8" r="4.6"/><path d="M8 .8v4M8 11.2v4M.8 8h4M11.2 8h4"/></svg>';

export interface NamedCheck {
    name: string; // as in the report
    base: string; // without layer and fibre
    layer: number | null; // from 1
    fibre: number | null; // from 1
    check: Check;
}

export function namedChecks(report: Report): NamedCheck[] {
    return Object.entries(report.checks ?? {}).map(([name, check]) => {
        const parts = /^(.*?)(?:-layer-(\d+))?(?:-(\d+))?$/.exec(name) as RegExpExecArray;
        return {
            name,
            base: parts[1],
            layer: parts[2] ? Number(parts[2]) : null,
            fibre: parts[3] ? Number(parts[3]) : null,
            check,
        };
    });
}

/** Those of its kind, or all its numbers where it has none of them or its kind is not known. */
function measuresOf(check: Check, kind: CheckKind | undefined): Measure[] {
    const known = kind?.measures.filter((m) => typeof numberOf(check, m.key) === 'number');
    if (known?.length) return known;
    const keys = Object.keys(check).filter((k) => typeof numberOf(check, k) === 'number');
    return keys
        .filter((k) => !/(^|_)limit(_|$)/.test(k))
        .map((key) => {
            const unit = /(_mm_s|_mm|_deg|_s)$/.exec(key)?.[0] ?? '';
            const worst = /^(worst|max)/.test(key);
            const limit = worst ? keys.find((k) => k === `limit${unit}`) : undefined;
            return limit ? { key, limit } : { key };
        })
        .sort((a, b) => Number('limit' in b) - Number('limit' in a));
}

function numberOf(check: Check, key: string): number | undefined {
    const value = (check as unknown as Record<string, unknown>)[key];
    return typeof value === 'number' ? value : undefined;
}

/** \param head, tail what stands before the measure's own name and at the end of its row */
function measureHtml(check: Check, measure: Measure, head: string, tail: string): string {
    const value = numberOf(check, measure.key) as number;
    const { words, unit } = keyInWords(measure.key);
    const limit =
        typeof measure.limit === 'number'
            ? measure.limit
            : measure.limit === undefined
              ? undefined
              : numberOf(check, measure.limit);
    const show = (v: number) => (unit === '×' ? percent(v) : valueInWords(v, unit));
    let gauge = '';
    if (limit !== undefined && limit > 0) {
        const share = Math.min(value / limit, 1.25) / 1.25;
        const over = measure.least ? value < limit : value > limit * 1.0001;
        gauge = `<span class="gauge${over ? ' over' : ''}" aria-hidden="true"><i style="width:${(100 * share).toFixed(1)}%"></i></span>`;
    }
    const bound = limit === undefined ? '' : `${measure.least ? '\u2265' : '\u2264'}\u202f${show(limit)}`;
    return (
        `<tr><th scope="row">${head}<span>${escapeHtml(measure.label ?? words)}</span></th><td class="num">${show(value)}</td>` +
        `<td class="num muted">${bound}</td><td class="gauge-cell">${gauge}</td><td class="place-cell">${tail}</td></tr>`
    );
}

export class Checks {
    onPlace: (place: Place) => void = () => {};
    private readonly all: NamedCheck[];

    constructor(
        private readonly host: HTMLElement,
        report: Report,
        private readonly kinds: Record<string, CheckKind>,
        private readonly layers: number,
    ) {
        this.all = namedChecks(report);
        host.addEventListener('click', (event) => {
            const row = (event.target as HTMLElement).closest<HTMLElement>('[data-check]');
            const check = this.all.find((c) => c.name === row?.dataset.check)?.check;
            if (check?.place) this.onPlace(check.place);
        });
    }

    failed(): NamedCheck[] {
        return this.all.filter((c) => !c.check.ok);
    }

    count(): number {
        return this.all.length;
    }

    /** \param layer index, or null for all */
    show(layer: number | null): void {
        const layerOf = (c: NamedCheck) => (c.layer ?? 1) - 1;
        const shown = this.all.filter((c) => layer === null || layerOf(c) === layer);
        const failed = shown.filter((c) => !c.check.ok);
        let html = failed.map((c) => this.checkHtml(c)).join('');
        const passed = shown.filter((c) => c.check.ok);
        if (this.layers > 1 && layer === null) {
            for (let l = 0; l < this.layers; ++l) {
                const of = passed.filter((c) => layerOf(c) === l);
                if (of.length) html += `<h3>Layer ${l + 1}</h3>${of.map((c) => this.checkHtml(c)).join('')}`;
            }
        } else html += passed.map((c) => this.checkHtml(c)).join('');
        this.host.innerHTML = html || '<p class="muted">The report has no checks.</p>';
    }

    private checkHtml(item: NamedCheck): string {
        const { check } = item;
        const kind = this.kinds[item.base] as CheckKind | undefined;
        const title = kind?.title ?? sentence(item.base.replace(/[_-]/g, ' '));
        const suffix = [
            item.layer !== null && !check.ok ? `layer ${item.layer}` : '',
            item.fibre !== null ? `fibre ${item.fibre}` : '',
        ].filter(Boolean);
        const name = escapeHtml([title, ...suffix].join(', '));
        const place = check.place
            ? `<button type="button" class="plain" title="Show the place" aria-label="Show the place of ${name}">${kTarget}</button>`
            : '';
        const mark = check.ok
            ? '<i class="mark ok" role="img" aria-label="passed">\u2713</i>'
            : '<i class="mark bad" role="img" aria-label="failed">\u2715</i>';
        const head = `${mark}<b>${name}</b>`;
        const measures = measuresOf(check, kind);
        const rows = measures.map((m, i) => measureHtml(check, m, i === 0 ? head : '', i === 0 ? place : ''));
        if (!measures.length)
            rows.push(
                `<tr><th scope="row" colspan="4">${head}</th><td class="place-cell">${place}</td></tr>`,
            );
        const words = check.words ? `<p class="words">${escapeHtml(sentence(check.words))}</p>` : '';
        return (
            `<article class="check${check.ok ? '' : ' failed'}${check.place ? ' placed' : ''}" ` +
            `data-check="${escapeHtml(item.name)}"><table class="measures"><tbody>${rows.join('')}</tbody></table>${words}</article>`
        );
    }
}
