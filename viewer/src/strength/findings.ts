/** What was found of a wall's strength, in tables. */
import { fixed, number, withUnit } from '../format';
import type { PlyState, Wall } from './data';

const place = (state: PlyState): string => state.position_mm.map((x) => fixed(x, 1)).join(', ');

export function loadsOf(wall: Wall): string {
    const { pressure_MPa, axial_N, moment_Nmm } = wall.strength.loads;
    const moment = Math.hypot(...moment_Nmm);
    const loads: string[] = [];
    if (pressure_MPa) loads.push(`${withUnit(pressure_MPa, 'MPa')} inside`);
    if (axial_N) loads.push(`${withUnit(axial_N, 'N')} along`);
    if (moment) loads.push(withUnit(moment / 1000, 'N m'));
    return loads.join(', ');
}

export function figuresHtml(wall: Wall): string {
    const { strength } = wall;
    const figures: [string, string][] = [
        ['Load', loadsOf(wall)],
        ['First ply fails at', `${number(strength.first_failure?.reserve)} × load`],
        ['99 % bear', `${number(strength.reserve_of_99_percent)} × load`],
        ['Shells', number(strength.shells)],
        ['Plies, most', number(strength.plies.most)],
    ];
    return figures.map(([k, v]) => `<div><dt>${k}</dt><dd>${v}</dd></div>`).join('');
}

export function layersHtml(wall: Wall): string {
    const rows = wall.strength.layers.map((state, i) => {
        if (!state) return `<tr><th scope="row">${i + 1}</th><td colspan="5">no ply</td></tr>`;
        const { along, across, shear } = state.stress_MPa;
        return (
            `<tr class="placed" tabindex="0" data-layer="${state.layer}"><th scope="row">${state.layer}</th>` +
            `<td>${number(state.reserve)}</td><td>${fixed(state.angle_deg, 1)}</td>` +
            `<td>${fixed(along, 0)}</td><td>${fixed(across, 0)}</td><td>${fixed(shear, 0)}</td></tr>` +
            `<tr class="note"><td></td><td colspan="5">at ${place(state)} mm</td></tr>`
        );
    });
    return (
        '<h3>Weakest ply of each layer</h3><table class="grid"><thead><tr><th scope="col">Layer</th>' +
        '<th scope="col" title="by which all loads may grow until it fails">Reserve</th><th scope="col">Angle, °</th>' +
        '<th scope="col">Along</th><th scope="col">Across</th><th scope="col">Shear</th>' +
        `</tr></thead><tbody>${rows.join('')}</tbody></table>` +
        '<p class="hint">Stresses in MPa, along and across the fibre. Criterion of Tsai and Wu: where the first ply cracks, most often across its fibre. A wall with a ' +
        'liner bears more.</p>'
    );
}

export function hoverHtml(wall: Wall, face: number): string {
    const utilisation = wall.utilisation[face];
    const reserve = utilisation > 0 ? `fails at ${number(1 / utilisation)} × load` : 'no ply';
    return `<strong>${reserve}</strong><br>${withUnit(wall.thickness[face], 'mm')}, ${wall.plies[face]} plies<br>shell ${face + 1}`;
}
