/** Tabs after the usual pattern: arrow keys move, one panel is shown. */

export class Tabs {
    onShow: (id: string) => void = () => {};
    private readonly tabs: { id: string; button: HTMLButtonElement; panel: HTMLElement }[] = [];

    constructor(
        private readonly list: HTMLElement,
        private readonly panels: HTMLElement,
    ) {
        list.addEventListener('keydown', (event) => {
            const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
            if (!step) return;
            event.preventDefault();
            event.stopPropagation();
            const now = this.tabs.findIndex((t) => t.button.getAttribute('aria-selected') === 'true');
            const next = this.tabs[(now + step + this.tabs.length) % this.tabs.length];
            this.show(next.id);
            next.button.focus();
        });
    }

    add(id: string, label: string): HTMLElement {
        const button = document.createElement('button');
        button.type = 'button';
        button.id = `tab-${id}`;
        button.textContent = label;
        button.setAttribute('role', 'tab');
        button.setAttribute('aria-controls', `panel-${id}`);
        button.addEventListener('click', () => this.show(id));
        const panel = document.createElement('section');
        panel.id = `panel-${id}`;
        panel.className = 'panel';
        panel.setAttribute('role', 'tabpanel');
        panel.setAttribute('aria-labelledby', button.id);
        panel.dataset.title = label;
        this.list.append(button);
        this.panels.append(panel);
        this.tabs.push({ id, button, panel });
        return panel;
    }

    show(id: string): void {
        for (const tab of this.tabs) {
            const on = tab.id === id;
            tab.button.setAttribute('aria-selected', String(on));
            tab.button.tabIndex = on ? 0 : -1;
            tab.panel.classList.toggle('shown', on);
        }
        this.onShow(id);
    }
}
