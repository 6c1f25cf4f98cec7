// Draws nothing of its own: what is there is multiplied (Dimmer).
out vec4 color;

void main() { color = vec4(0.0); }
