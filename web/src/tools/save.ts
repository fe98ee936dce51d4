// The page that needs no server, made by the server.

/** Fetches that of the picture of a version, or says why it cannot be had. */
export async function savePage(address: URL, version: number): Promise<{ page: Blob } | { refusal: string }> {
  try {
    const response = await fetch(new URL(`offline/${version}`, address), { cache: "no-store" });
    return response.ok ? { page: await response.blob() } : { refusal: (await response.text()) || `It cannot be made: ${response.status}` };
  } catch (error) {
    return { refusal: `It cannot be had: ${error instanceof Error ? error.message : String(error)}` };
  }
}
