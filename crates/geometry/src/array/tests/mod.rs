mod join;
mod peer;
mod per_vertex;
mod properties;
