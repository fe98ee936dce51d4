// The page that needs no server, made by the server.

/** Fetches it, or says why it cannot be had. */
export async function savePage(address: URL): Promise<{ page: Blob } | { refusal: string }> {
  try {
    const response = await fetch(new URL("offline.html", address), { cache: "no-store" });
    return response.ok ? { page: await response.blob() } : { refusal: (await response.text()) || `It cannot be made: ${response.status}` };
  } catch (error) {
    return { refusal: `It cannot be had: ${error instanceof Error ? error.message : String(error)}` };
  }
}
