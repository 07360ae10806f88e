// For a camera inside the horizon.

const SEES_INSIDE: bool = true;
