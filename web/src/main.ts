import "./app.css";
import { App } from "./app.ts";
import { connect } from "./core/connection.ts";
import { replay, savedPart, unpack } from "./core/offline.ts";
import { Store } from "./core/store.ts";
import { fromServer } from "./view/buffers.ts";

const host = document.getElementById("app");
if (host) {
  const store = new Store();
  // The address ends in the token and a slash; everything else is relative to it.
  const address = new URL("./", window.location.href);
  const saved = savedPart();
  if (saved) {
    new App(store, host, address, (digest) => unpack(saved, digest));
    replay(store, saved);
  } else {
    new App(store, host, address, fromServer(address));
    connect(store, address);
  }
}
