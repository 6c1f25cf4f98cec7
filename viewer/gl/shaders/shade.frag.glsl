// For what is so small, or changes so slowly, that its vertices have the light.
in vec3 shade;
out vec4 color;

void main() { color = vec4(shade, 1.0); }
