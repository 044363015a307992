// Depth alone: empties one square of the shadow atlas.
void main() {}
