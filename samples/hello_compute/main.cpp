// One kernel, one image: declare, compile, run, and save what comes back.
#include <heliograph/heliograph.hpp>

#include <heliograph_kernels/hello_compute.hpp>

#include <iostream>

struct View {
    float x, y, halfHeight;
};

int main(int argc, char** argv) try {
    const std::string file = argc > 1 ? argv[1] : "hello_compute.png";
    helio::Device device;
    helio::Graph graph(device);
    const helio::Image picture = graph.image("picture", {{640, 480}, helio::Format::RGBA32F});
    graph.compute("mandelbrot", helio::shaders::mandelbrot)
        .overwrites({{"uPicture", picture}})
        .record([=](helio::Commands& c) {
            c.push(View{-0.6f, 0.0f, 1.2f}).dispatchOver(picture);
        });
    const auto pixels = graph.readback<float>(picture);

    helio::Plan plan = graph.compile();
    const helio::Execution run = plan.execute();
    const helio::ImageF image{640, 480, {"R", "G", "B", "A"}, pixels.wait(run), {}};
    helio::saveImage(file, image);

    std::cout << "the Mandelbrot set, computed on " << device.info().name << ", is in " << file << '\n';
    for (const helio::PassTiming& time : plan.timings(run))
        std::cout << time.name << ": " << time.milliseconds << " ms\n";
} catch (const helio::Error& error) {
    std::cerr << "hello_compute: error: " << error.what() << '\n';
    return 1;
}
