/** Key figures, bare wall with its reasons, and the layers of a laminate. */
import { clock, escapeHtml, fixed, number, percent, sentence, withUnit } from './format';
import type { Laminate, LayerReport, Plan, Report, Uncovered, WallReport } from './types';

/** \param duration of all programs on the page, 0 where it has none */
export function figuresHtml(report: Report, duration: number): string {
    const plan = report.plan;
    const laminate = report.laminate;
    const metres = laminate?.fibre_m ?? (plan?.fibre_length_mm ?? NaN) / 1000;
    const figures: [string, string][] = [
        ['Machine', escapeHtml(report.machine ?? '\u2013')],
        ['Fibre', withUnit(metres, 'm', 4)],
        ['Time', clock(laminate?.time_s ?? (duration || (report.program?.duration_s ?? 0)))],
    ];
    if (laminate?.mass_g) figures.push(['Mass', withUnit(laminate.mass_g, 'g')]);
    if (plan?.courses !== undefined) figures.push(['Courses', number(plan.courses)]);
    const covered = plan?.coverage?.fraction;
    if (covered !== undefined) figures.push(['Covered', percent(covered)]);
    return figures.map(([k, v]) => `<div><dt>${k}</dt><dd>${v}</dd></div>`).join('');
}

function wallArea(report: Report): number {
    const kept = report.mandrel?.regions?.filter((r) => r.kept) ?? [];
    return kept.length ? kept.reduce((sum, r) => sum + r.area_mm2, 0) : (report.mandrel?.area_mm2 ?? NaN);
}

function measuresHtml(rows: [string, string][]): string {
    const lines = rows.map(([k, v]) => `<tr><th scope="row">${k}</th><td class="num">${v}</td></tr>`);
    return `<table class="measures"><tbody>${lines.join('')}</tbody></table>`;
}

function coverageHtml(plan: Plan | undefined): string {
    const c = plan?.coverage;
    if (!c) return '';
    const rows: [string, string][] = [];
    if (c.fraction !== undefined) rows.push(['Wall covered', percent(c.fraction)]);
    if (c.mean_layers !== undefined) rows.push(['Bands over a place, mean', number(c.mean_layers)]);
    if (c.max_layers !== undefined) rows.push(['Bands over a place, most', number(c.max_layers)]);
    if (c.p1_layers !== undefined) rows.push(['Bands over 99 % of the wall in reach, at least', number(c.p1_layers)]);
    if (plan?.fibre_factor) rows.push(['Fibre over that of the layers asked for', number(plan.fibre_factor)]);
    if (plan?.turn_share !== undefined) rows.push(['Fibre in turns, cut off', percent(plan.turn_share)]);
    return measuresHtml(rows);
}

function uncoveredHtml(list: Uncovered[], wall: number, covered: number | undefined): string {
    if (!list.length) {
        const words =
            covered === undefined || covered < 1
                ? 'The plan gives no reasons for the wall that stays bare.'
                : 'No wall stays bare.';
        return `<p class="muted">${words}</p>`;
    }
    const regions = new Set(list.map((u) => u.region)).size > 1;
    const rows = [...list]
        .sort((a, b) => b.area_mm2 - a.area_mm2)
        .map(
            (u) =>
                `<tr><td class="num">${fixed(u.area_mm2 / 100, 2)}</td><td class="num">${percent(u.area_mm2 / wall)}</td>` +
                `${regions ? `<td class="num">${u.region}</td>` : ''}<td>${escapeHtml(sentence(u.reason))}</td></tr>`,
        );
    return (
        `<table class="grid"><thead><tr><th scope="col" class="num">Area cm²</th><th scope="col" class="num">Share</th>` +
        `${regions ? '<th scope="col" class="num">Region</th>' : ''}<th scope="col">Why it stays bare</th></tr></thead>` +
        `<tbody>${rows.join('')}</tbody></table>`
    );
}

/** \param layer index, or null for all together */
export function bareHtml(report: Report, layer: number | null): string {
    const plan = layer === null ? report.plan : (report.layers?.[layer]?.plan ?? report.plan);
    return (
        coverageHtml(plan) + uncoveredHtml(plan?.uncovered ?? [], wallArea(report), plan?.coverage?.fraction)
    );
}

function angleText(angle: number | null | undefined): string {
    return typeof angle === 'number' ? `${angle.toFixed(1)}°` : '\u2013';
}

function wallHtml(wall: WallReport): string {
    const rows: [string, string][] = [
        ['Layers asked for, on average', number(wall.asked_layers)],
        ['Wall in reach', percent(wall.reachable)],
        ['Of it thinner than asked for', percent(wall.below)],
        ['Laid over asked for, mean', number(wall.mean_over_asked)],
        ['On 99 % of the wall in reach at least', number(wall.p1_over_asked)],
        ['Spread over the mean', number(wall.cv)],
        ['Fibre over that of the layers asked for', number(wall.fibre_factor)],
    ];
    if (wall.bound) rows.push(['No plan of single courses takes less than', number(wall.bound.least_factor)]);
    rows.push(['Fibre in turns, cut off', percent(wall.turn_share)]);
    for (const thin of wall.thin)
        rows.push([
            `Too thin in region ${thin.region}, and by how much`,
            `${percent(thin.below)}, ${withUnit(thin.lacks_mm, 'mm')}`,
        ]);
    return `<p class="muted sum">Wall of layers ${wall.first_layer} to ${wall.last_layer}</p>${measuresHtml(rows)}`;
}

/** Those of the report; one that is the whole plan where it tells none. */
function layersOf(report: Report, kind: string): LayerReport[] {
    if (report.layers?.length) return report.layers;
    return [{ layer: 1, kind, plan: report.plan, ...report.cost }];
}

/** Columns of the layers; `paper`: where there is room. */
const kLayerColumns: { label: string; paper?: true; text: (l: LayerReport) => string; sum?: (l: Laminate) => string }[] = [
    { label: 'Asked<br>angle', paper: true, text: (l) => angleText(l.plan?.asked_angle_deg) },
    { label: 'Angle<br>laid', text: (l) => angleText(l.angle_deg ?? l.plan?.angles?.mean_deg) },
    { label: 'Circuits', paper: true, text: (l) => number(l.plan?.pattern?.circuits) },
    { label: 'Starts', paper: true, text: (l) => number(l.plan?.pattern?.starts) },
    { label: 'Dwell', paper: true, text: (l) => angleText(l.plan?.pattern?.dwell_deg) },
    { label: 'Mean<br>mm', text: thicknessText('mean'), sum: thicknessText('mean') },
    { label: 'Max<br>mm', text: thicknessText('max'), sum: thicknessText('max') },
    { label: 'Fibre<br>m', text: (l) => fixed(l.fibre_m ?? NaN, 1), sum: (l) => fixed(l.fibre_m ?? NaN, 1) },
    { label: 'Mass<br>g', text: (l) => fixed(l.mass_g ?? NaN, 1), sum: (l) => fixed(l.mass_g ?? NaN, 1) },
    { label: 'Time', text: (l) => timeText(l.time_s), sum: (l) => timeText(l.time_s) },
];

function thicknessText(key: 'mean' | 'max'): (of: Laminate) => string {
    return (of) => fixed(of.thickness_mm?.[key] ?? NaN, 2);
}

function timeText(seconds: number | undefined): string {
    return seconds === undefined ? '\u2013' : clock(seconds);
}

/** \param kind of the layer where the report tells none */
export function layersHtml(report: Report, kind: string): string {
    const layers = layersOf(report, kind);
    const several = layers.length > 1;
    const cells = (tag: string, text: (c: (typeof kLayerColumns)[number]) => string): string =>
        kLayerColumns
            .map((c) => `<${tag} class="num${c.paper ? ' paper' : ''}">${text(c)}</${tag.split(' ')[0]}>`)
            .join('');
    const row = (l: LayerReport, i: number) =>
        `<tr${several ? ` tabindex="0" data-layer="${i}"` : ''}><td class="num">${l.layer ?? i + 1}</td>` +
        `<td>${escapeHtml(l.kind)}</td>${cells('td', (c) => c.text(l))}</tr>` +
        (l.cut_because
            ? `<tr class="note"><td></td><td colspan="${kLayerColumns.length + 1}">A new fibre: ${escapeHtml(l.cut_because)}</td></tr>`
            : '');
    const sum = report.laminate;
    const foot = sum
        ? `<tfoot><tr><td></td><td>All</td>${cells('td', (c) => c.sum?.(sum) ?? '')}</tr></tfoot>`
        : '';
    return (
        `<p class="muted sum">${several ? 'From the mandrel outward. Choose one to see it alone.' : 'One layer.'}</p>` +
        `<table class="grid layers"><thead><tr><th scope="col" class="num">#</th><th scope="col">Kind</th>` +
        `${cells('th scope="col"', (c) => c.label)}</tr></thead><tbody>${layers.map(row).join('')}</tbody>${foot}</table>` +
        (report.walls ?? []).map(wallHtml).join('')
    );
}
