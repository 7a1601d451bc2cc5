// SPDX-License-Identifier: MIT
// OpenCV's HoughLinesPointSet on the points of `rhotrack bench hough`, which runs this where it was
// built:
//     hough_opencv POINTS RHO_MAX RHO_CELL THETA_CELL MIN_VOTES ROUNDS
// POINTS: pairs of float32. Prints the least time of a call in milliseconds.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <opencv2/imgproc.hpp>

static std::vector<cv::Point2f> read_points(const char *path)
{
    std::vector<cv::Point2f> points;
    float pair[2];
    if (FILE *file = std::fopen(path, "rb")) {
        while (std::fread(pair, sizeof pair, 1, file) == 1) {
            points.emplace_back(pair[0], pair[1]);
        }
        std::fclose(file);
    }
    return points;
}

int main(int argc, char **argv)
{
    if (argc != 7) {
        std::fprintf(stderr, "hough_opencv: POINTS RHO_MAX RHO_CELL THETA_CELL MIN_VOTES ROUNDS\n");
        return 2;
    }
    const std::vector<cv::Point2f> points = read_points(argv[1]);
    const double rho_max = std::atof(argv[2]), rho_cell = std::atof(argv[3]);
    const double theta_cell = std::atof(argv[4]);
    double least_ms = 1e9;
    cv::setNumThreads(1);
    for (int round = 0; round < std::atoi(argv[6]); round++) {
        std::vector<cv::Vec3d> lines;
        const auto start = std::chrono::steady_clock::now();
        cv::HoughLinesPointSet(points, lines, 1024, std::atoi(argv[5]), -rho_max, rho_max, rho_cell,
                               0.0, CV_PI, theta_cell);
        const std::chrono::duration<double, std::milli> took =
            std::chrono::steady_clock::now() - start;
        least_ms = took.count() < least_ms ? took.count() : least_ms;
    }
    std::printf("%.6f\n", least_ms);
    return 0;
}
