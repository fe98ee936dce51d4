// The graph laid out left to right by dagre.
import { Graph, layout } from "@dagrejs/dagre";
import type { GraphNode } from "./protocol.ts";

export type Box = { name: string; x: number; y: number; width: number; height: number };
export type Line = { from: string; to: string; inputs: string[]; points: { x: number; y: number }[] };
export type Layout = { boxes: Box[]; lines: Line[]; width: number; height: number };

export const BOX_WIDTH = 168;
export const BOX_HEIGHT = 54;

/** Places nodes in columns by what they read; the same graph always gives the same picture. */
export function layoutGraph(nodes: GraphNode[]): Layout {
  if (nodes.length === 0) return { boxes: [], lines: [], width: 0, height: 0 };
  const graph = new Graph({ multigraph: false });
  graph.setGraph({ rankdir: "LR", nodesep: 14, ranksep: 46, marginx: 12, marginy: 12 });
  graph.setDefaultEdgeLabel(() => ({}));
  const names = new Set(nodes.map((node) => node.name));
  for (const { name } of nodes) graph.setNode(name, { width: BOX_WIDTH, height: BOX_HEIGHT });
  const inputs = new Map<string, Line>();
  for (const node of nodes) {
    for (const input of node.inputs) {
      for (const from of input.from.filter((name) => names.has(name) && name !== node.name)) {
        const key = `${from}\n${node.name}`;
        const line = inputs.get(key) ?? { from, to: node.name, inputs: [], points: [] };
        line.inputs.push(input.name);
        inputs.set(key, line);
        graph.setEdge(from, node.name);
      }
    }
  }
  layout(graph);
  const boxes = nodes.map(({ name }) => {
    const { x, y, width, height } = graph.node(name) as unknown as Box;
    return { name, x: x - width / 2, y: y - height / 2, width, height };
  });
  const lines = [...inputs.values()].map((line) => {
    const edge = graph.edge(line.from, line.to) as { points?: Line["points"] };
    return { ...line, points: edge.points ?? [] };
  });
  const { width = 0, height = 0 } = graph.graph() as { width?: number; height?: number };
  return { boxes, lines, width, height };
}
