// Shaders that pull vertices out of the server's raw buffers: `gl_VertexID` names
// triangle and corner, nothing is prepared on the way. Normals come from
// derivatives, polygon edges from one bit per side and barycentric coordinates.

/** Reading the buffers; shared by drawing and picking. */
const PULL = /* glsl */ `
precision highp float;
precision highp int;
uniform highp sampler2D positions;
uniform highp usampler2D triangles;
uniform highp usampler2D triangleFaces;
uniform highp usampler2D baseFaces;
uniform bool hasPanels;
uniform highp usampler2D panelStates;
uniform int panelStateCount;
uniform bool isolating;
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;

ivec2 at(int index) { return ivec2(index & 4095, index >> 12); }

// Whether any panel differs from the others: else their states are not looked up.
bool hasStates() { return isolating || panelStateCount > 0; }

// A panel is what came from one face of the base, or a face where there is no base.
uint panelOf(uint face) { return hasPanels ? texelFetch(baseFaces, at(int(face)), 0).x : face; }

// Bits of a panel: 1 hidden, 2 among the isolated, 4 selected.
uint stateOf(uint panel) { return int(panel) < panelStateCount ? texelFetch(panelStates, at(int(panel)), 0).x : 0u; }

bool isHidden(uint state) { return (state & 1u) != 0u || (isolating && (state & 2u) == 0u); }

// Outside of what is drawn, all three corners of a triangle.
const vec4 NOWHERE = vec4(2.0, 2.0, 2.0, 1.0);
`;

export const SURFACE_VERTEX = /* glsl */ `${PULL}
uniform highp usampler2D edges;
uniform highp sampler2D values;
uniform int valuesOn; // 0 nothing, 1 vertices, 2 faces

out vec3 worldPosition;
out vec3 viewPosition;
out vec3 corner;
out float smoothValue;
flat out float faceValue;
flat out uint face;
flat out uint sides;
flat out uint selected;

void main() {
  int triangle = gl_VertexID / 3;
  int k = gl_VertexID - 3 * triangle;
  uvec3 ids = texelFetch(triangles, at(triangle), 0).xyz;
  int vertex = int(k == 0 ? ids.x : k == 1 ? ids.y : ids.z);
  face = texelFetch(triangleFaces, at(triangle), 0).x;
  sides = texelFetch(edges, at(triangle), 0).x;
  uint state = hasStates() ? stateOf(panelOf(face)) : 0u;
  selected = state & 4u;
  corner = vec3(k == 0, k == 1, k == 2);
  smoothValue = 0.0;
  faceValue = 0.0;
  if (valuesOn == 1) smoothValue = texelFetch(values, at(vertex), 0).x;
  if (valuesOn == 2) faceValue = texelFetch(values, at(int(face)), 0).x;
  vec4 world = modelMatrix * vec4(texelFetch(positions, at(vertex), 0).xyz, 1.0);
  vec4 seen = viewMatrix * world;
  worldPosition = world.xyz;
  viewPosition = seen.xyz;
  gl_Position = isHidden(state) ? NOWHERE : projectionMatrix * seen;
}
`;

export const SURFACE_FRAGMENT = /* glsl */ `
precision highp float;
precision highp int;
in vec3 worldPosition;
in vec3 viewPosition;
in vec3 corner;
in float smoothValue;
flat in float faceValue;
flat in uint face;
flat in uint sides;
flat in uint selected;

uniform mat4 viewMatrix;
uniform int valuesOn;
uniform sampler2D colours;
uniform vec2 range;
uniform bool categorical;
uniform vec3 classes[8];
uniform vec3 frontColour;
uniform vec3 backColour;
uniform vec3 edgeColour;
uniform vec3 unknownColour;
uniform vec3 pickColour;
uniform int edgeMode; // 0 none, 1 polygons, 2 triangles
uniform float edgeWidth;
uniform int pickedFace;
uniform bool cut;
uniform vec4 cutPlane;
uniform bool ghost;
uniform float pixelRatio;

out vec4 colour;

vec3 coloured(float value) {
  if (isnan(value) || isinf(value)) return unknownColour;
  if (categorical) return classes[int(mod(floor(value + 0.5), 8.0))];
  return texture(colours, vec2(clamp((value - range.x) / (range.y - range.x), 0.0, 1.0) * (255.0 / 256.0) + 0.5 / 256.0, 0.5)).rgb;
}

// How much of this pixel an edge covers: the distance to a side in pixels is its
// barycentric coordinate over that coordinate's change per pixel.
float edgeCover() {
  vec3 change = fwidth(corner);
  vec3 pixels = corner / max(change, vec3(1e-6));
  float near = 1e6;
  float crowd = 0.0;
  bool all3 = edgeMode == 2;
  // Side k runs from corner k to the next and lies opposite the corner after that.
  if (all3 || (sides & 1u) != 0u) { near = min(near, pixels.z); crowd = max(crowd, change.z); }
  if (all3 || (sides & 2u) != 0u) { near = min(near, pixels.x); crowd = max(crowd, change.x); }
  if (all3 || (sides & 4u) != 0u) { near = min(near, pixels.y); crowd = max(crowd, change.y); }
  float line = 1.0 - smoothstep(edgeWidth - 0.5, edgeWidth + 0.5, near);
  // Where triangles are as small as the line, lines would cover everything.
  return line * (1.0 - 0.85 * smoothstep(0.12, 0.5, crowd));
}

void main() {
  if (cut && dot(vec4(worldPosition, 1.0), cutPlane) > 0.0) discard;
  float edge = edgeMode == 0 ? 0.0 : edgeCover();
  vec3 normal = normalize(cross(dFdx(viewPosition), dFdy(viewPosition)));
  bool back = !gl_FrontFacing;
  vec3 base = back ? backColour : frontColour;
  if (valuesOn == 1) base = coloured(smoothValue);
  if (valuesOn == 2) base = coloured(faceValue);
  bool picked = int(face) == pickedFace;
  if (picked || selected != 0u) {
    // Stripes over colours that mean something, so that both are seen.
    vec2 pixel = gl_FragCoord.xy / pixelRatio;
    bool stripe = fract((pixel.x - pixel.y) / 8.0) < 0.5;
    float share = picked ? 0.85 : 0.5;
    base = mix(base, pickColour, valuesOn == 0 ? share : stripe ? 0.95 : picked ? 0.4 : 0.0);
  }
  vec3 up = (viewMatrix * vec4(0.0, 0.0, 1.0, 0.0)).xyz;
  float key = max(dot(normal, normalize(vec3(-0.45, 0.6, 0.75))), 0.0);
  float sky = 0.5 + 0.5 * dot(normal, up);
  float head = max(normal.z, 0.0);
  // Colours that mean something are shaded less, so that the legend can be trusted.
  float shade = valuesOn == 0 ? 0.26 + 0.46 * key + 0.2 * sky + 0.14 * head : 0.6 + 0.26 * key + 0.1 * sky + 0.08 * head;
  vec3 lit = base * shade;
  float alpha = ghost ? mix(picked || selected != 0u ? 0.5 : 0.09, 0.55, edge) : 1.0;
  colour = vec4(mix(lit, edgeColour, ghost ? edge : edge * 0.85), alpha);
}
`;

/** Ids under the pointer: face + 1, panel, nearest corner's vertex, depth. */
export const PICK_VERTEX = /* glsl */ `${PULL}
out vec3 worldPosition;
out vec3 corner;
flat out uint face;
flat out uint panel;
flat out uvec3 ids;

void main() {
  int triangle = gl_VertexID / 3;
  int k = gl_VertexID - 3 * triangle;
  ids = texelFetch(triangles, at(triangle), 0).xyz;
  int vertex = int(k == 0 ? ids.x : k == 1 ? ids.y : ids.z);
  face = texelFetch(triangleFaces, at(triangle), 0).x;
  panel = panelOf(face);
  corner = vec3(k == 0, k == 1, k == 2);
  vec4 world = modelMatrix * vec4(texelFetch(positions, at(vertex), 0).xyz, 1.0);
  worldPosition = world.xyz;
  gl_Position = isHidden(stateOf(panel)) ? NOWHERE : projectionMatrix * viewMatrix * world;
}
`;

export const PICK_FRAGMENT = /* glsl */ `
precision highp float;
precision highp int;
in vec3 worldPosition;
in vec3 corner;
flat in uint face;
flat in uint panel;
flat in uvec3 ids;
uniform bool cut;
uniform vec4 cutPlane;
out uvec4 id;

void main() {
  if (cut && dot(vec4(worldPosition, 1.0), cutPlane) > 0.0) discard;
  uint nearest = corner.x >= corner.y && corner.x >= corner.z ? ids.x : corner.y >= corner.z ? ids.y : ids.z;
  id = uvec4(face + 1u, panel, nearest, floatBitsToUint(gl_FragCoord.z));
}
`;

/** Arrows of directions: a shaft and two strokes of a head, six vertices each. */
export const ARROW_VERTEX = /* glsl */ `
precision highp float;
precision highp int;
uniform highp sampler2D positions;
uniform highp sampler2D outward;
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform int every;
uniform float size;
out vec3 worldPosition;

ivec2 at(int index) { return ivec2(index & 4095, index >> 12); }

void main() {
  int arrow = gl_VertexID / 6;
  int k = gl_VertexID - 6 * arrow;
  int vertex = arrow * every;
  vec3 foot = texelFetch(positions, at(vertex), 0).xyz;
  vec3 shaft = size * texelFetch(outward, at(vertex), 0).xyz;
  vec3 tip = foot + shaft;
  vec4 seenTip = viewMatrix * modelMatrix * vec4(tip, 1.0);
  vec3 along = (viewMatrix * modelMatrix * vec4(shaft, 0.0)).xyz;
  // The head lies across the line of sight, so that it is seen from everywhere.
  vec3 across = cross(along, vec3(0.0, 0.0, 1.0));
  across = length(across) > 1e-9 ? normalize(across) : vec3(1.0, 0.0, 0.0);
  float head = 0.2 * length(shaft);
  vec4 seen = seenTip;
  if (k == 0) seen = viewMatrix * modelMatrix * vec4(foot, 1.0);
  if (k == 3) seen.xyz -= 0.2 * along - 0.5 * head * across;
  if (k == 5) seen.xyz -= 0.2 * along + 0.5 * head * across;
  worldPosition = (modelMatrix * vec4(foot, 1.0)).xyz;
  gl_Position = projectionMatrix * seen;
  // A hair nearer than the surface, or arrows would flicker where they start.
  gl_Position.z -= 1e-4 * gl_Position.w;
}
`;

export const ARROW_FRAGMENT = /* glsl */ `
precision highp float;
in vec3 worldPosition;
uniform vec3 arrowColour;
uniform bool cut;
uniform vec4 cutPlane;
out vec4 colour;

void main() {
  if (cut && dot(vec4(worldPosition, 1.0), cutPlane) > 0.0) discard;
  colour = vec4(arrowColour, 1.0);
}
`;
