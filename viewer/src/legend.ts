/** The legend over the picture. */
import { category, cssColour, gradient, kBare, kOverLimit } from './colour';
import type { Colouring } from './colour';
import { escapeHtml, number, withUnit } from './format';

const kMaxCategories = 8;

export function swatch(colour: string, words: string, hatched = false): string {
    const style = hatched
        ? `background:repeating-linear-gradient(-45deg, ${colour} 0 3px, #f6d5bd 3px 6px)`
        : `background:${colour}`;
    return `<span class="key"><i class="swatch" style="${style}"></i>${escapeHtml(words)}</span>`;
}

/** \param bare whether bare spots exist and are shown */
export function legendHtml(by: Colouring, bare: boolean, transitions: boolean): string {
    const title = `<strong>${escapeHtml(by.label)}${by.unit ? `, ${by.unit}` : ''}</strong>`;
    const keys: string[] = [];
    let scale = '';
    if (by.kind === 'categories') {
        const count = Math.min(by.max + 1, kMaxCategories);
        for (let n = 0; n < count; ++n) keys.push(swatch(cssColour(category(n)), String(n)));
        if (by.max + 1 > kMaxCategories) keys.push('<span class="key">then again</span>');
    } else {
        const limit = by.limit === null ? '' : '<span class="limit">limit</span>';
        const half = (by.min + by.max) / 2;
        const middle = number(by.id === 'course' ? Math.round(half) : half);
        scale =
            `<div class="ramp${by.limit === null ? '' : ' limited'}" style="background:${gradient()}"></div>` +
            `<div class="ticks"><span>${number(by.min)}</span><span>${middle}</span>` +
            `<span>${limit}${by.unit === '°' ? withUnit(by.max, by.unit) : number(by.max)}</span></div>`;
        if (by.limit !== null) keys.push(swatch(kOverLimit, 'over the limit'));
    }
    if (transitions && (by.id === 'course' || by.id === 'family')) keys.push(swatch('#9aa3ad', 'transition'));
    if (bare) keys.push(swatch(kBare, 'bare', true));
    const list = keys.length ? `<div class="keys-row">${keys.join('')}</div>` : '';
    return `${title}${scale}${list}<small>${escapeHtml(by.note)}</small>`;
}
