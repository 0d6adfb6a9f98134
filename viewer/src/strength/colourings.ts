/** What the wall can be coloured by. */
import { gradient, kOverLimit, sequential } from '../colour';
import { number } from '../format';
import { swatch } from '../legend';
import type { Wall } from './data';

export type ColouringId = 'utilisation' | 'thickness' | 'plies';

export interface Colouring {
    id: ColouringId;
    label: string;
    unit: string;
    values: Float32Array | Int32Array;
    max: number;
    note: string;
}

const kOver: [number, number, number] = [0xe0, 0x00, 0x7a];

function largest(values: Float32Array | Int32Array): number {
    let max = 0;
    for (const value of values) max = Math.max(max, value);
    return max;
}

/** The scale of utilisation ends where 99 % of the wall are: a bare spot would take all of it. */
export function colouringsOf(wall: Wall): Colouring[] {
    const reserve = wall.strength.reserve_of_99_percent;
    return [
        {
            id: 'utilisation',
            label: 'Utilisation',
            unit: '',
            values: wall.utilisation,
            max: reserve ? 1 / reserve : Math.max(largest(wall.utilisation), 1e-9),
            note: 'Load over that at which the first ply fails.',
        },
        {
            id: 'thickness',
            label: 'Thickness',
            unit: 'mm',
            values: wall.thickness,
            max: largest(wall.thickness),
            note: 'Of all plies.',
        },
        {
            id: 'plies',
            label: 'Plies computed',
            unit: '',
            values: wall.plies,
            max: largest(wall.plies),
            note: 'Near angles of one layer are one ply.',
        },
    ];
}

export function colourOfValue(by: Colouring, value: number): [number, number, number] {
    return by.id === 'utilisation' && value > by.max ? kOver : sequential(by.max > 0 ? value / by.max : 0);
}

export function legendHtml(by: Colouring): string {
    const unit = by.unit ? `, ${by.unit}` : '';
    const over = by.id === 'utilisation' ? `<div class="keys-row">${swatch(kOverLimit, 'the worst hundredth of the wall')}</div>` : '';
    return (
        `<strong>${by.label}${unit}</strong><div class="ramp" style="background:${gradient()}"></div>` +
        `<div class="ticks"><span>0</span><span>${number(by.max / 2)}</span><span>${number(by.max)}</span></div>` +
        `${over}<small>${by.note}</small>`
    );
}
