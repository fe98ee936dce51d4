// The socket to the server. It comes back by itself: after a server was killed
// and started again the page goes on where it was.
import type { FromServer } from "./protocol.ts";
import type { Store } from "./store.ts";

/** Pause before the n-th attempt to connect again: growing, at most 2 s. */
export function pause(attempt: number): number {
  return Math.min(2000, 100 * 2 ** attempt);
}

/** Connects and keeps connecting; messages go into the store. */
export function connect(store: Store, address: URL): void {
  const socketAddress = new URL("socket", address);
  socketAddress.protocol = socketAddress.protocol === "https:" ? "wss:" : "ws:";
  let attempt = 0;

  const open = (): void => {
    const socket = new WebSocket(socketAddress);
    store.send = (message) => {
      if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
    };
    socket.addEventListener("open", () => {
      attempt = 0;
      store.setLink("open");
    });
    socket.addEventListener("message", (event) => {
      store.receive(JSON.parse(String(event.data)) as FromServer);
    });
    socket.addEventListener("close", () => {
      void again();
    });
  };

  const again = async (): Promise<void> => {
    const refused = await isRefused(address);
    store.setLink(refused ? "refused" : "retrying");
    setTimeout(open, pause(attempt));
    attempt += 1;
  };
  open();
}

/** Whether a server answers here that does not know this page's token. */
async function isRefused(address: URL): Promise<boolean> {
  try {
    const response = await fetch(new URL("./", address), { cache: "no-store" });
    return response.status === 401;
  } catch {
    return false;
  }
}
