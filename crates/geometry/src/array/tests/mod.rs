mod join;
mod parts;
mod peer;
mod per_vertex;
mod properties;
