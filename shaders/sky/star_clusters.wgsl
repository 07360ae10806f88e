#define_import_path lensrunner::sky::star_clusters

// The clusters of the catalogue, in a table of two texels each.

#import lensrunner::gpu::bindings::TABLE_ROW
#import lensrunner::gpu::types::StarCluster

@group(1) @binding(0) var star_clusters: texture_2d<f32>;

fn cluster_texel(k: u32) -> vec4<f32> {
    return textureLoad(star_clusters, vec2<u32>(k % TABLE_ROW, k / TABLE_ROW), 0);
}

fn star_cluster(number: u32) -> StarCluster {
    let a = cluster_texel(2u * number);
    let b = cluster_texel(2u * number + 1u);
    return StarCluster(a.xyz, a.w, b.x, b.y, b.z, b.w);
}
