/** What was found of a part, in tables: the words are those of `meshwind inspect`. */
import { escapeHtml, fixed, number, percent, sentence, withUnit } from '../format';
import { swatch } from '../legend';
import { faceArea } from './data';
import type { Part, Region } from './data';
import { cssOf, kDetails, kindOf, kKinds, kSharp } from './kinds';
import type { Colours } from './kinds';
import { category, cssColour } from '../colour';
import type { Hit } from './stage';

const kMaxRegions = 60; // rows; lettering that is kept makes hundreds
const kMaxInLegend = 8;

const area = (mm2: number): string => withUnit(mm2 / 100, 'cm²', 4);

/** Lengths of the box around the part, mandrel frame. */
function sizeOf(points: Float32Array): number[] {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < points.length; ++i) {
        low[i % 3] = Math.min(low[i % 3], points[i]);
        high[i % 3] = Math.max(high[i % 3], points[i]);
    }
    return low.map((l, k) => high[k] - l);
}

export function figuresHtml(part: Part): string {
    const { inspected } = part;
    const size = sizeOf(part.points).map((s) => fixed(s, 1));
    const figures: [string, string][] = [
        ['Unit', `${withUnit(inspected.unit_mm, 'mm')}, ${escapeHtml(inspected.unit_rule)}`],
        ['Size', `${size.join(' × ')}\u202fmm`],
        ['Wound', area(inspected.area_mm2)],
        ['Rims', String(inspected.rims.length)],
        ['Triangles of the file', number(inspected.file_triangles)],
    ];
    return figures.map(([k, v]) => `<div><dt>${k}</dt><dd>${v}</dd></div>`).join('');
}

/** Keys of a job and options stand out. */
function withCode(words: string): string {
    return escapeHtml(words)
        .replace(/&quot;mandrel&quot;: \{[^}]*\}/g, '<code>$&</code>')
        .replace(/--[a-z]+ [a-z_.]+(=[0-9.]+)?/g, '<code>$&</code>')
        .replace(/&quot;axis&quot;/g, '<code>$&</code>');
}

function remarksHtml(part: Part): string {
    const { remarks, places } = part.inspected;
    const placed = new Set(places.map((p) => p.remark));
    if (!remarks.length) return '<p class="hint">None: all of the file is taken as it is.</p>';
    const items = remarks.map(
        (words, i) =>
            `<li data-remark="${i}"${placed.has(i) ? ' class="placed" tabindex="0"' : ''}>` +
            `<span class="pin">${i + 1}</span>${withCode(sentence(words))}</li>`,
    );
    return `<ul class="remarks">${items.join('')}</ul>`;
}

function regionRow(region: Region, by: Colours): string {
    return (
        `<tr data-region="${region.id}"><td><i class="swatch" style="background:${cssOf(region, by)}"></i></td>` +
        `<td class="num">${region.id}</td><td>${escapeHtml(region.kind)}</td><td>${region.kept ? 'yes' : 'no'}</td>` +
        `<td class="num">${number(region.triangles)}</td><td class="num">${fixed(region.area_mm2, 2)}</td>` +
        `<td class="num">${percent(region.visible_fraction)}</td></tr>`
    );
}

export function regionRowsHtml(part: Part, by: Colours): string {
    const { regions } = part.inspected;
    const rest = regions.slice(kMaxRegions);
    const sum = rest.reduce((total, r) => total + r.area_mm2, 0);
    const more = rest.length
        ? `<tr class="note"><td></td><td colspan="6">and ${rest.length} smaller ones, together ${fixed(sum, 2)} mm²</td></tr>`
        : '';
    return regions.slice(0, kMaxRegions).map((r) => regionRow(r, by)).join('') + more;
}

function table(name: string, heads: [string, boolean][], rows: string): string {
    const head = heads
        .map(([words, isNumber]) => `<th scope="col"${isNumber ? ' class="num"' : ''}>${words}</th>`)
        .join('');
    return `<table class="grid ${name}"><thead><tr>${head}</tr></thead><tbody>${rows}</tbody></table>`;
}

function rimsHtml(part: Part): string {
    const { rims } = part.inspected;
    if (!rims.length) return '<p class="hint">None: what is wound is closed.</p>';
    const rows = rims.map(
        (rim) =>
            `<tr data-rim="${rim.id}" class="placed" tabindex="0"><td class="num">${rim.id}</td>` +
            `<td class="num">${fixed(rim.radius, 3)}</td><td class="num">${fixed(rim.circularity_mm, 3)}</td>` +
            `<td class="num">${rim.cut_off_mm > 0 ? fixed(rim.cut_off_mm, 2) : '\u2013'}</td>` +
            `<td class="num">${rim.centre.map((c) => fixed(c, 1)).join('\u2002')}` +
            `<br><span class="muted">${rim.axis.map((c) => fixed(c, 3)).join('\u2002')}</span></td></tr>`,
    );
    const heads: [string, boolean][] = [
        ['Rim', true],
        ['Radius mm', true],
        ['Off circle', true],
        ['Cut off', true],
        ['Centre, axis', true],
    ];
    return table('rims', heads, rows.join(''));
}

function axesHtml(part: Part): string {
    const { candidates } = part.inspected.axis;
    const rows = candidates.map(
        (axis, i) =>
            `<tr data-axis="${i}"${i ? '' : ' class="chosen"'}><th scope="row">${i ? '' : '\u2713 '}${escapeHtml(axis.rule)}</th>` +
            `<td class="num">${fixed(axis.swing_mm, 1)}</td><td class="num">${axis.rims}</td>` +
            `<td class="num">${fixed(axis.gap_deg, 0)}°</td><td class="num">${fixed(axis.angle_deg, 1)}°</td>` +
            `<td class="num">${fixed(axis.off_mm, 1)}</td></tr>` +
            `<tr class="note" data-axis="${i}"><td colspan="6">${escapeHtml(sentence(axis.why))}</td></tr>`,
    );
    const heads: [string, boolean][] = [
        ['Axis', false],
        ['Swing mm', true],
        ['Rims', true],
        ['Open', true],
        ['Tilt', true],
        ['Off mm', true],
    ];
    return table('axes', heads, rows.join(''));
}

/** Lines of what is printed, by the word they begin with. */
function shapeHtml(text: string): string {
    const shown = ['file', 'unit', 'size', 'spindle axis', 'file frame', 'revolution', 'tube', 'surface', 'accuracy'];
    const rows = text.split('\n').flatMap((line) => {
        const found = /^(\S.{11}\S?)\s*(.*)$/.exec(line);
        const key = line.slice(0, 14).trim();
        return found && shown.includes(key) ? [[key, line.slice(14)]] : [];
    });
    return `<dl class="shape">${rows
        .map(([k, v]) => `<dt>${sentence(k)}</dt><dd>${escapeHtml(v)}</dd>`)
        .join('')}</dl>`;
}

export function findingsHtml(part: Part): string {
    const { refused, text } = part.header;
    const heads: [string, boolean][] = [
        ['', false],
        ['Id', true],
        ['Kind', false],
        ['Wound', false],
        ['Triangles', true],
        ['Area mm²', true],
        ['Visible', true],
    ];
    return (
        (refused ? `<p class="refused">The main job refuses it: ${withCode(refused)}</p>` : '') +
        `<h3>Remarks</h3>${remarksHtml(part)}` +
        `<h3>Regions</h3>${table('regions', heads, regionRowsHtml(part, 'kind'))}` +
        '<p class="hint">Others are wound by <code>"mandrel": {"keep_regions": [..]}</code> in the job.</p>' +
        `<h3>Rims</h3>${rimsHtml(part)}` +
        `<h3>Spindle</h3>${axesHtml(part)}` +
        '<p class="hint">Another is given by <code>"mandrel": {"axis": ..}</code> in the job. Swing: how far the part reaches from it; ' +
        'rims that lie around it; the widest angle about it without wall; tilt and distance from the chosen one.</p>' +
        `<h3>Shape</h3>${shapeHtml(text)}` +
        '<p class="hint">Another unit is given by <code>--units</code>.</p>'
    );
}

export function legendHtml(part: Part, by: Colours): string {
    const { regions, winding_mesh: mesh } = part.inspected;
    const row = (colour: string, words: string, mm2: number, hatched = false): string =>
        swatch(colour, words, hatched).replace('</span>', `<b>${area(mm2)}</b></span>`);
    const rows: string[] = [];
    if (by === 'region') {
        for (const r of regions.slice(0, kMaxInLegend)) {
            rows.push(row(cssColour(category(r.id)), `region ${r.id}, ${r.kind}`, r.area_mm2));
        }
        if (regions.length > kMaxInLegend) rows.push('<span class="key">then again</span>');
    } else {
        for (const kind of kKinds) {
            const own = regions.filter((r) => kindOf(r) === kind);
            const mm2 = own.reduce((sum, r) => sum + r.area_mm2, 0);
            if (mm2 > 0) rows.push(row(cssColour(kind.rgb), kind.words, mm2));
        }
    }
    if (mesh.details > 0) rows.push(row(cssColour(kDetails.rgb), kDetails.words, mesh.details_mm2));
    let sharp = 0;
    for (let f = 0; f < part.sharp.length; ++f) {
        if (part.sharp[f]) sharp += faceArea(part.points, part.faces, f);
    }
    if (sharp > 0) {
        rows.push(row(kSharp, `too sharp for a tow of ${number(part.header.tow_width_mm)}\u202fmm`, sharp, true));
    }
    return `<div class="keys-row">${rows.join('')}</div>`;
}

export function hoverHtml(part: Part, hit: Hit): string {
    const rows: [string, string][] = [];
    let title = sentence(kDetails.words);
    if (hit.region >= 0) {
        const region = part.inspected.regions[hit.region];
        title = `Region ${region.id}, ${region.kind}`;
        rows.push(['wound', region.kept ? 'yes' : 'no'], ['area', area(region.area_mm2)]);
        rows.push(['sees the outside', percent(region.visible_fraction)]);
        if (hit.sharp) rows.push(['too sharp', `for ${number(part.header.tow_width_mm)}\u202fmm`]);
    }
    const p = hit.place;
    const three = (v: number[]): string => v.map((c) => fixed(c, 1)).join('\u2002');
    rows.push(['mandrel x y z', three([p.x, p.y, p.z])]);
    const inFile = fileFrom(part, [p.x, p.y, p.z]);
    const digits = part.inspected.unit_mm > 10 ? 4 : 1;
    rows.push(['file x y z', inFile.map((c) => fixed(c, digits)).join('\u2002')]);
    return `<h4>${escapeHtml(title)}</h4><dl>${rows.map(([k, v]) => `<dt>${k}</dt><dd>${v}</dd>`).join('')}</dl>`;
}

/** A place in the file's own frame and units. */
export function fileFrom(part: Part, place: number[]): number[] {
    const { file_to_mandrel: m, unit_mm: unit } = part.inspected;
    const moved = place.map((c, k) => c - m[k][3]);
    // The rows are those of a rotation times the unit.
    return [0, 1, 2].map((k) => (m[0][k] * moved[0] + m[1][k] * moved[1] + m[2][k] * moved[2]) / unit ** 2);
}
