// SPDX-License-Identifier: Apache-2.0
// Loads the modules of a page anew for each page: they inherit the number of the page from the module that imports them.
export async function resolve(specifier, context, next) {
  const found = await next(specifier, context);
  const page = context.parentURL && new URL(context.parentURL).searchParams.get("page");
  return page && specifier.startsWith("./") ? {...found, url: `${found.url}?page=${page}`} : found;
}
