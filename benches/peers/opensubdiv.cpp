// Catmull-Clark by OpenSubdiv's own way for whole meshes: the topology is
// refined level by level, then positions are interpolated level by level.
//
//     opensubdiv FOLDER
//
// As peers.py: `ready`, then for each line the nanoseconds of processor time.

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

using namespace OpenSubdiv;

struct Point {
    double p[3];
    void Clear() { p[0] = p[1] = p[2] = 0; }
    void AddWithWeight(const Point &other, double weight) {
        for (int k = 0; k < 3; ++k) p[k] += weight * other.p[k];
    }
};

template <class T> static std::vector<T> read(const std::string &path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) {
        std::cout << "absent " << path << " is missing" << std::endl;
        std::exit(0);
    }
    std::vector<T> values(size_t(file.tellg()) / sizeof(T));
    file.seekg(0);
    file.read(reinterpret_cast<char *>(values.data()), std::streamsize(values.size() * sizeof(T)));
    return values;
}

static long long now() {
    timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1000000000LL * time.tv_sec + time.tv_nsec;
}

int main(int, char **arguments) {
    const std::string folder = arguments[1];
    const auto coordinates = read<double>(folder + "/positions.f64");
    const auto corners = read<uint32_t>(folder + "/quads.u32");
    const int levels = int(read<uint32_t>(folder + "/levels.u32").at(0));
    const std::vector<int> sizes(corners.size() / 4, 4);
    const std::vector<int> indices(corners.begin(), corners.end());
    std::vector<Point> coarse(coordinates.size() / 3);
    for (size_t v = 0; v < coarse.size(); ++v)
        for (int k = 0; k < 3; ++k) coarse[v].p[k] = coordinates[3 * v + k];

    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = int(coarse.size());
    descriptor.numFaces = int(sizes.size());
    descriptor.numVertsPerFace = sizes.data();
    descriptor.vertIndicesPerFace = indices.data();
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;

    std::cout << "ready" << std::endl;
    for (std::string line; std::getline(std::cin, line);) {
        const long long start = now();
        Factory::Options how(Sdc::SCHEME_CATMARK, options);
        std::unique_ptr<Far::TopologyRefiner> refiner(Factory::Create(descriptor, how));
        refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(levels));
        std::vector<Point> from = coarse;
        const Far::PrimvarRefinerReal<double> primvar(*refiner);
        for (int level = 1; level <= levels; ++level) {
            std::vector<Point> to(size_t(refiner->GetLevel(level).GetNumVertices()));
            primvar.Interpolate(level, from, to);
            from.swap(to);
        }
        std::cout << now() - start << std::endl;
    }
}
