import { Component, type ComponentChildren } from "preact";

interface Shown {
  name: string;
  isShown: boolean;
  version: number; // of what the player has
  children: ComponentChildren;
}

/** What a tab shows. It stays while another one is looked at, with what was filled in and what it waits for; then it is
    not made anew with every moment. */
export class Panel extends Component<Shown> {
  shouldComponentUpdate(next: Shown): boolean {
    return next.isShown || this.props.isShown || next.version !== this.props.version;
  }
  render({ name, isShown, children }: Shown) {
    return <div id={isShown ? "panel" : undefined} role="tabpanel" aria-labelledby={`tab-${name}`} hidden={!isShown}>{children}</div>;
  }
}
