/** Numbers of the face and the band under the pointer. */
import type { Page } from './data';
import { escapeHtml, fixed, withUnit } from './format';
import type { Hit } from './picking';

function rows(pairs: [string, string][]): string {
    return pairs.map(([k, v]) => `<dt>${k}</dt><dd>${v}</dd>`).join('');
}

/** \param layer index of the layer shown, or null for all together */
export function hoverHtml(page: Page, hit: Hit, layer: number | null): string {
    let html = '';
    if (hit.band) {
        const { fibre, station: i } = hit.band;
        const piece = fibre.header.pieces[fibre.piece[i]];
        const where = page.layers.length > 1 ? `, layer ${fibre.layer + 1}` : '';
        const head = piece
            ? `${piece.kind === 'course' ? 'Course' : 'Transition'} ${piece.course}${where}`
            : `Fibre${where}`;
        html +=
            `<h4>${escapeHtml(head)}</h4><dl>` +
            rows([
                ['along the fibre', withUnit(fibre.s[i], 'mm', 5)],
                ['slip', fixed(fibre.slip[i], 3)],
                ['bridging', `${fixed(fibre.bridge[i], 3)}\u202fmm`],
                ['free length', withUnit(fibre.freeLength[i], 'mm')],
                ['angle', `${fixed(fibre.angle[i], 1)}°`],
            ]) +
            '</dl>';
    }
    if (hit.face >= 0) {
        const values = layer === null ? page.total : page.layers[layer].values;
        const bare = values.layers[hit.face] > 0 ? '' : ' \u00b7 bare';
        const wall: [string, string][] = page.wall
            ? [['wall', `${fixed(page.wall.laid[hit.face], 2)} of ${fixed(page.wall.asked[hit.face], 0)} layers`]]
            : [];
        html +=
            `<h4>Mandrel, region ${page.region[hit.face]}${bare}</h4><dl>` +
            rows([
                ['layers', fixed(values.layers[hit.face], 2)],
                ...wall,
                ['thickness', `${fixed(values.thickness[hit.face], 2)}\u202fmm`],
                ['mean angle', `${fixed(values.angle[hit.face], 1)}°`],
                ['at x y z', [hit.place.x, hit.place.y, hit.place.z].map((c) => fixed(c, 1)).join('\u2002')],
            ]) +
            '</dl>';
    } else html += '<h4>Extension</h4>';
    return html;
}
