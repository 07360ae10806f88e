// For a camera outside the horizon, and for what is never inside.

const SEES_INSIDE: bool = false;
