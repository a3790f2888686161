#pragma once
/** @file Everything public. */
#include <heliograph/camera.hpp>
#include <heliograph/device.hpp>
#include <heliograph/error.hpp>
#include <heliograph/features.hpp>
#include <heliograph/file.hpp>
#include <heliograph/fourier.hpp>
#include <heliograph/graph.hpp>
#include <heliograph/image.hpp>
#include <heliograph/kernel.hpp>
#include <heliograph/photometry.hpp>
#include <heliograph/pose.hpp>
#include <heliograph/renderer.hpp>
#include <heliograph/scene.hpp>
#include <heliograph/surfaces.hpp>
#include <heliograph/verify.hpp>
#include <heliograph/version.hpp>
