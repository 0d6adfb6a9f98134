/** Key figures, bare wall with its reasons, and the layers of a laminate. */
import { clock, escapeHtml, fixed, number, percent, sentence, withUnit } from './format';
import type { LayerReport, Plan, Report, Uncovered, WallReport } from './types';

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

function angleText(layer: LayerReport): string {
    return typeof layer.angle_deg === 'number' ? `${layer.angle_deg.toFixed(1)}°` : '\u2013';
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

export function layersHtml(report: Report): string {
    const layers = report.layers ?? [];
    const row = (l: LayerReport, i: number) =>
        `<tr tabindex="0" data-layer="${i}"><td class="num">${l.layer ?? i + 1}</td><td>${escapeHtml(l.kind)}</td>` +
        `<td class="num">${angleText(l)}</td><td class="num">${fixed(l.thickness_mm?.mean ?? NaN, 2)}</td>` +
        `<td class="num">${fixed(l.thickness_mm?.max ?? NaN, 2)}</td><td class="num">${fixed(l.fibre_m ?? NaN, 1)}</td>` +
        `<td class="num">${fixed(l.mass_g ?? NaN, 1)}</td><td class="num">${clock(l.time_s ?? NaN)}</td></tr>` +
        (l.cut_because
            ? `<tr class="note"><td></td><td colspan="7">A new fibre: ${escapeHtml(l.cut_because)}</td></tr>`
            : '');
    const sum = report.laminate;
    const foot = sum
        ? `<tfoot><tr><td></td><td>All</td><td></td><td class="num">${fixed(sum.thickness_mm?.mean ?? NaN, 2)}</td>` +
          `<td class="num">${fixed(sum.thickness_mm?.max ?? NaN, 2)}</td><td class="num">${fixed(sum.fibre_m ?? NaN, 1)}</td>` +
          `<td class="num">${fixed(sum.mass_g ?? NaN, 1)}</td><td class="num">${clock(sum.time_s ?? NaN)}</td></tr></tfoot>`
        : '';
    return (
        `<p class="muted sum">From the mandrel outward. Choose one to see it alone.</p>` +
        `<table class="grid layers"><thead><tr><th scope="col" class="num">#</th><th scope="col">Kind</th>` +
        `<th scope="col" class="num">Angle</th><th scope="col" class="num">Mean<br>mm</th><th scope="col" class="num">Max<br>mm</th>` +
        `<th scope="col" class="num">Fibre<br>m</th><th scope="col" class="num">Mass<br>g</th><th scope="col" class="num">Time</th></tr></thead>` +
        `<tbody>${layers.map(row).join('')}</tbody>${foot}</table>` +
        (report.walls ?? []).map(wallHtml).join('')
    );
}
